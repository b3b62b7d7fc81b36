#!/usr/bin/env bash
# boot.sh DIR MODULES TIMEOUT_S COMMAND: boots the virtual machine of setup.sh in software, loads kernel modules
# ("vivid:n_devs=1,comedi_test": options after colons), runs a shell command in the current folder and relays its output
# and exit code. 125: the machine itself failed. The command sees this machine's files; what it writes is gone afterwards.
set -uo pipefail
dir=$1 modules=$2 timeout_s=$3 command=$4

io=$(mktemp -d)
children=()
trap 'kill "${children[@]}" 2>/dev/null; rm -rf "$io"' EXIT
trap 'exit 130' INT TERM
printf 'cd %q\nexport PATH=%q HOME=/root\n%s\n' "$PWD" "$PATH" "$command" >"$io/command.sh"
: >"$io/output"

tail -q -n +1 -f "$io/output" &
children+=($!)

timeout "$timeout_s" qemu-system-x86_64 -machine q35 -accel tcg,thread=multi -cpu max -smp 2 -m 2048 \
    -nodefaults -no-user-config -no-reboot -display none -serial "file:$io/console" \
    -kernel "$dir/vmlinux" -initrd "$dir/initrd.gz" \
    -append "console=ttyS0 quiet loglevel=3 panic=-1 modules=$modules" \
    -fsdev local,id=host,path=/,security_model=none,readonly=on,multidevs=remap \
    -device virtio-9p-pci,fsdev=host,mount_tag=host \
    -fsdev local,id=io,path="$io",security_model=none -device virtio-9p-pci,fsdev=io,mount_tag=io
ended=$?
sleep 0.2 # the relay's last lines

if [[ -s $io/exit-code ]]; then exit "$(cat "$io/exit-code")"; fi
echo "the virtual machine did not finish (qemu ended with $ended); its console:" >&2
tail -30 "$io/console" >&2
exit 125
