#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# boot.sh [--own-time] [--keep FOLDER] DIR MODULES TIMEOUT_S COMMAND: boots the virtual machine of setup.sh in software,
# loads kernel modules ("vivid:n_devs=1,comedi_test": options after colons), runs a shell command in the current folder
# and relays its output and exit code. 125: the machine itself failed. The command sees this machine's files; what it
# writes is gone afterwards, except for what it writes to /vmio/kept, which is in FOLDER then.
#
# --own-time: time in the machine goes by as its instructions do, one a nanosecond, and jumps where it waits. However
# slow and busy the machine outside, a loop inside is as punctual as on a processor of its own. Without it, clocks
# inside are those outside, and two processors share the work, three to six times slower than they should be.
set -uo pipefail
machine=(-accel tcg,thread=multi -cpu max -smp 2)
kept=""
while [[ $1 == --* ]]; do
    case $1 in
        # Without what is emulated number by number: fused multiplications and wide vectors of them.
        --own-time)
            machine=(-accel tcg,thread=single -icount shift=0,sleep=off -rtc clock=vm
                -cpu max,avx=off,avx2=off,fma=off -smp 1)
            ;;
        --keep) kept=$2 && shift ;;
        *) echo "boot.sh: unknown option $1" >&2 && exit 2 ;;
    esac
    shift
done
dir=$1 modules=$2 timeout_s=$3 command=$4

io=$(mktemp -d)
children=()
trap 'kill "${children[@]}" 2>/dev/null; rm -rf "$io"' EXIT
trap 'exit 130' INT TERM
printf 'cd %q\nexport PATH=%q HOME=/root\n%s\n' "$PWD" "$PATH" "$command" >"$io/command.sh"
: >"$io/output"
mkdir "$io/kept"

tail -q -n +1 -f "$io/output" &
children+=($!)

timeout "$timeout_s" qemu-system-x86_64 -machine q35 "${machine[@]}" -m 2048 \
    -nodefaults -no-user-config -no-reboot -display none -serial "file:$io/console" \
    -kernel "$dir/vmlinux" -initrd "$dir/initrd.gz" \
    -append "console=ttyS0 quiet loglevel=3 panic=-1 modules=$modules" \
    -fsdev local,id=host,path=/,security_model=none,readonly=on,multidevs=remap \
    -device virtio-9p-pci,fsdev=host,mount_tag=host \
    -fsdev local,id=io,path="$io",security_model=none -device virtio-9p-pci,fsdev=io,mount_tag=io
ended=$?
sleep 0.2 # the relay's last lines
[[ -z $kept ]] || cp -r "$io/kept/." "$kept/"

if [[ -s $io/exit-code ]]; then exit "$(cat "$io/exit-code")"; fi
echo "the virtual machine did not finish (qemu ended with $ended); its console:" >&2
tail -30 "$io/console" >&2
exit 125
