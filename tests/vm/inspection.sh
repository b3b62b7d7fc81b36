#!/usr/bin/env bash
# inspection.sh BUILD-DIR: a whole inspection in which images and stage both cross the kernel. comedi_rig simulates
# what the Comedi loopback was commanded and feeds v4l2loopback; fidservo inspects through both.
set -uo pipefail
build=$1
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
out=$(mktemp -d)
seconds=540

"$build/tests/vm/comedi_rig" "$here/inspection/rig.yaml" "$here/../../assets/demo/plate.yaml" \
    /dev/comedi0 /dev/video20 "$seconds" >"$out/truth" &
rig=$!
trap 'kill $rig 2>/dev/null' EXIT
until [[ -s $out/truth ]]; do
    kill -0 $rig 2>/dev/null || { echo "the rig's other side did not start" && exit 1; }
    sleep 1
done

timeout "$seconds" "$build/fidservo" inspect "$here/inspection/recipe.yaml" --rig "$here/inspection/rig.yaml" \
    --stage comedi:/dev/comedi0 --camera v4l2:/dev/video20 --out "$out/run"
code=$?
tail -1 "$out/truth"
# "Done, and the plate fails": site 41 has a pad in the wrong place, the other two are sound.
python3 - "$out/run" <<'PYTHON' || exit 1
import csv, json, sys
run = sys.argv[1]
rows = list(csv.DictReader(open(run + "/results.csv")))
for row in rows:
    print(row["site"], row["check"], row["feature"], row["value"], row["unit"], row["verdict"], row["reason"])
print("control loop:", json.dumps({k: v for k, v in json.load(open(run + "/run.json"))["control_loop"].items()
                                   if k != "late_histogram_us"}))
wrong = [row for row in rows if (row["verdict"] != "pass") != (row["site"] == "41" and row["check"].startswith("mark_centre")
                                                  and row["feature"].startswith("pad"))]
assert not wrong, wrong
assert {row["site"] for row in rows} == {"35", "41", "47"}
PYTHON
((code == 1)) || { echo "exit code $code instead of 1" && exit 1; }
