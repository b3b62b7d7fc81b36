#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# inspection.sh BUILD-DIR [killed]: a whole inspection in which images and stage both cross the kernel. comedi_rig
# simulates what the Comedi loopback was commanded and feeds v4l2loopback; fidservo inspects through both.
# killed: the run gets a SIGKILL once a site is measured; the board has to be at zero then, and the run is taken up again.
set -uo pipefail
build=$1 killed=${2:-}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=$(mktemp -d)
seconds=840

"$build/tests/vm/comedi_rig" "$here/inspection/rig.yaml" "$here/../../assets/demo/plate.yaml" \
    /dev/comedi0 /dev/video20 "$seconds" >"$out/truth" &
rig=$!
trap 'kill $rig 2>/dev/null' EXIT
until [[ -s $out/truth ]]; do
    kill -0 $rig 2>/dev/null || { echo "the rig's other side did not start" && exit 1; }
    sleep 1
done

inspection=("$build/fidservo" inspect "$here/inspection/recipe.yaml" --rig "$here/inspection/rig.yaml"
    --stage comedi:/dev/comedi0 --camera v4l2:/dev/video20 --no-diagnosis --out "$out/run")

# What comedi_rig saw of the outputs, once it has looked twice more.
outputs_from_now_on() {
    local lines
    lines=$(wc -l <"$out/truth")
    until (($(wc -l <"$out/truth") > lines + 2)); do sleep 1; done
    tail -1 "$out/truth"
}

if [[ $killed == killed ]]; then
    "${inspection[@]}" &
    run=$!
    until grep -qs '"event":"visit"' "$out/run/journal.jsonl"; do
        kill -0 $run 2>/dev/null || { echo "the run ended before a site was measured" && exit 1; }
        sleep 1
    done
    kill -KILL $run
    wait $run
    after=$(outputs_from_now_on)
    echo "killed; $after"
    [[ $after == *"motor -0.000 V, heater -0.000 V" || $after == *"motor 0.000 V, heater 0.000 V" ]] ||
        { echo "the outputs are not zero" && exit 1; }
    inspection+=(--resume)
fi

timeout "$seconds" "${inspection[@]}"
code=$?
outputs_from_now_on
# "Done, and the plate fails": site 41 has a pad in the wrong place, the other two are sound.
python3 - "$out/run" "$killed" <<'PYTHON' || exit 1
import csv, json, sys
run, killed = sys.argv[1:]
rows = list(csv.DictReader(open(run + "/results.csv")))
for row in rows:
    print(row["site"], row["check"], row["feature"], row["value"], row["unit"], row["verdict"], row["reason"])
about = json.load(open(run + "/run.json"))
print("control loop:", json.dumps({k: v for k, v in about["control_loop"].items() if k != "late_histogram_us"}))
wrong = [row for row in rows if (row["verdict"] != "pass") != (row["site"] == "41" and row["check"].startswith("mark_centre")
                                                  and row["feature"].startswith("pad"))]
assert not wrong, wrong
assert {row["site"] for row in rows} == {"35", "41", "47"}
assert about["resumed"] == (1 if killed else 0), about["resumed"]
PYTHON
((code == 1)) || { echo "exit code $code instead of 1" && exit 1; }
