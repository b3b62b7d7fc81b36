#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh VM-DIR BUILD-DIR [GROUP...]: the device tests, a boot a group. Exit code 0 if all groups passed, or if there is no
# virtual machine to run them in: they are skipped then.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
vm=$1 build=$2
shift 2

for part in "$vm/vmlinux" "$vm/initrd.gz" "$(command -v qemu-system-x86_64 || echo qemu-system-x86_64)"; do
    if [[ ! -s $part ]]; then
        echo "device tests: skipped: no virtual machine: $part is missing (./run test-devices makes it)"
        exit 0
    fi
done

# The board with which the stage was published, at its usual place; there is none in the machine.
multiq3="/usr/sbin/comedi_config /dev/comedi0 multiq3 0x320,5,2"

# With its usual two buffers v4l2loopback writes into frames that a slow reader has not yet fetched.
loopback="v4l2loopback:video_nr=20:exclusive_caps=0:max_buffers=8"

# group: kernel modules | seconds allowed | command | option of boot.sh. Without modules: a command that boots for itself.
declare -A groups=(
    [vivid]="vivid:n_devs=1:node_types=0x1:vid_cap_nr=10|900|$build/tests/vm/vivid_test"
    [comedi]="comedi:comedi_num_legacy_minors=1,multiq3,comedi_test|600|$multiq3 && $build/tests/vm/comedi_vm_test"
    [inspection]="$loopback,comedi_test|900|$here/inspection.sh $build|--own-time"
    [killed]="$loopback,comedi_test|900|$here/inspection.sh $build killed|--own-time"
    [hidden]="||$here/hidden.sh $vm $build $loopback,comedi_test"
    [loopback]="$loopback|900|$build/tests/vm/loopback_test && $build/tests/vm/record_test"
)
order=(vivid loopback comedi inspection killed hidden)
(($#)) && order=("$@")

failed=0
for group in "${order[@]}"; do
    [[ -v groups[$group] ]] || { echo "no group '$group' (allowed: ${!groups[*]})" >&2 && exit 2; }
    IFS='|' read -r modules timeout_s command option <<<"${groups[$group]}"
    printf '\n== device tests: %s\n' "$group"
    began=$SECONDS
    if [[ -n $modules ]]; then
        "$here/boot.sh" ${option:+"$option"} "$vm" "$modules" "$timeout_s" "$command"
    else
        bash -c "$command"
    fi
    code=$?
    ((code == 0)) && word=passed || word="failed ($code)" failed=1
    echo "$group: $word, $((SECONDS - began)) s"
done
exit "$failed"
