#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# record.sh BUILD-DIR EFFECT EXPERIMENT SEED RIG.yaml: in the virtual machine, fidservo records an experiment on a rig that
# it knows by RIG.yaml. Stage and camera are comedi_rig's, behind the kernel's drivers: those of rig.yaml, with an effect
# that neither file states. The recording goes to /vmio/kept.
set -uo pipefail
build=$1 effect=$2 experiment=$3 seed=$4 rig_file=$5
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
truth=$(mktemp)

"$build/tests/vm/comedi_rig" "$here/rig.yaml" "$here/../../../assets/demo/plate.yaml" \
    /dev/comedi0 /dev/video20 3600 "$effect" >"$truth" &
rig=$!
trap 'kill $rig 2>/dev/null' EXIT
until [[ -s $truth ]]; do
    kill -0 $rig 2>/dev/null || { echo "the rig's other side did not start" && exit 1; }
    sleep 1
done

"$build/fidservo" record "$experiment" --seed "$seed" --rig "$rig_file" \
    --stage comedi:/dev/comedi0 --camera v4l2:/dev/video20 --out "/vmio/kept/$experiment-$seed"
