#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# hidden.sh VM-DIR BUILD-DIR MODULES [EFFECT...]: what is wrong with a rig that only a kernel's drivers show is found out. One
# effect after the other hides in the simulated machine behind them: fidservo records it, diagnose names the effect and
# writes a rig file; with that file fidservo records another experiment, in which nothing is wrong any more. The machine
# is booted for each recording; the diagnosis runs outside, where it is quick.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
vm=$1 build=$2 modules=$3
shift 3

# effect: its parameter and value | the experiment that shows it
declare -A hidden=(
    [drive_gain]="factor=1.1|macro-pulses"
    [airflow]="factor=0.7|micro-servo"
    [pixel_scale]="factor=1.03|macro-square"
)
order=(drive_gain airflow pixel_scale)
(($#)) && order=("$@")

out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# record EFFECT EXPERIMENT SEED RIG.yaml: in a machine of its own; the seed draws another excitation.
record() {
    "$here/boot.sh" --own-time --keep "$out" "$vm" "$modules" 900 "$here/hidden/record.sh $build $*"
}

# diagnose RIG.yaml RECORDING JSON [OPTION...]
diagnose() {
    "$build/fidservo" diagnose --rig "$1" "$2" --json "$3" "${@:4}"
}

# named_and_gone NAME PARAMETER=VALUE BEFORE.json AFTER.json: what the two diagnoses have to say.
named_and_gone() {
    python3 - "$@" <<'PYTHON'
import json, sys
name, setting, *files = sys.argv[1:]
value = float(setting.split("=")[1])
before, after = (json.load(open(file)) for file in files)
first = before["effects"][0] if before["effects"] else None
assert first and first["effect"] == name and first["probability"] > 0.5, "not named: %s" % before["effects"]
assert before["gap"]["before"] >= 10.0, "hardly hidden: %s" % before["gap"]
found = first["parameters"][0]["value"]
assert abs(found - value) < 0.1 * abs(value - 1.0), "%g instead of %g" % (found, value)
assert after["verdict"] == "no-gap", "with the new file: %s" % after
print("%s: named with probability %.2f, %g (hidden: %g), %.3g floors; with the new file %.3g"
      % (name, first["probability"], found, value, before["gap"]["before"], after["gap"]["before"]))
PYTHON
}

# found_out NAME PARAMETER=VALUE EXPERIMENT
found_out() {
    local name=$1 setting=$2 experiment=$3 folder=$out/$1
    mkdir -p "$folder"
    record "$name:$setting" "$experiment" 1 "$here/hidden/rig.yaml" &&
        diagnose "$here/hidden/rig.yaml" "$out/$experiment-1" "$folder/before.json" --write-rig "$folder/found.yaml" &&
        record "$name:$setting" "$experiment" 2 "$folder/found.yaml" &&
        diagnose "$folder/found.yaml" "$out/$experiment-2" "$folder/after.json" &&
        named_and_gone "$name" "$setting" "$folder/before.json" "$folder/after.json"
    local code=$?
    rm -rf "$out/$experiment"-*
    return $code
}

failed=0
for name in "${order[@]}"; do
    [[ -v hidden[$name] ]] || { echo "no effect '$name' (allowed: ${!hidden[*]})" >&2 && exit 2; }
    IFS='|' read -r setting experiment <<<"${hidden[$name]}"
    echo "-- hidden: $name:$setting"
    found_out "$name" "$setting" "$experiment" || failed=1
done
exit "$failed"
