#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# run.sh BUILD FOLDER [SEED]: deploy/slurm/fleet.sbatch on a Slurm cluster of one node, disturbed. As root.
#
# A fleet of quick campaigns is diagnosed as an array of 16 shards, two at a time. Meanwhile 20 of its processes, drawn by
# SEED (by default one of the clock, printed), are killed by SIGKILL: a shard's program, or the process of a task. The
# node's daemon is killed twice: once it is back at once and finds its tasks; once only when the controller has given the
# node up and queued its tasks again, which meanwhile go on and are ended when the node is back. In the end all results have to be there, byte for byte those
# of one run without shards, each made once: a file that was seen during the run is the same file at the end.
#
# All is in FOLDER: recordings/, one/ and many/ (results), cluster/ (daemons' logs), logs/ (shards'). Exit code 0: as it
# has to be.
set -euo pipefail
(($# >= 2)) || { echo "usage: run.sh BUILD FOLDER [SEED]" >&2 && exit 2; }
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
top=$(realpath "$here/../../..")
build=$(realpath "$1")
mkdir -p "$2"
folder=$(realpath "$2")
seed=${3:-$(($(date +%s) % 32768))}
cluster=$folder/cluster
# shellcheck source=tests/fleet/slurm/cluster.sh
source "$here/cluster.sh"
in_namespaces "${BASH_SOURCE[0]}" "$build" "$folder" "$seed"

readonly shards=16 kills=20 units=12 weeks=4 effort_s=4
readonly brief_stop_at=7 long_stop_at=14 limit_s=1800
readonly rig=$top/assets/rig.yaml program=$build/fidservo
RANDOM=$seed

say() { printf '\n== %s\n' "$*"; }
fail() { printf 'failed: %s\n' "$*" && failures=$((failures + 1)); }
failures=0

# Random number from $1 to $2.
drawn() { echo $(($1 + RANDOM % ($2 - $1 + 1))); }

write_recordings() {
    [[ -e $folder/recordings/complete ]] && return
    rm -rf "$folder/recordings"
    "$build/tests/fleet/write_fleet" "$folder/recordings" "$rig" $units $weeks 41 macro-square-1
    touch "$folder/recordings/complete"
}

diagnose=(diagnose --rig "$rig" --effort "$effort_s")

run_as_one() {
    rm -rf "$folder/one"
    "$program" fleet "${diagnose[@]}" "$folder"/recordings/*/* --out "$folder/one" || (($? == 1))  # 1: some cannot be diagnosed
}

# The results that are there, each with its file's number: one that is made again has another.
declare -A number_of=()
look_at_results() {
    local file number
    while read -r number file; do
        if [[ ${number_of[$file]:-$number} != "$number" ]]; then fail "$file was made twice"; fi
        number_of[$file]=$number
    done < <(cd "$folder/many/results" 2>/dev/null && stat --format='%i %n' -- *.json 2>/dev/null)
}

queued() { [[ -n $(squeue --noheader --jobs="$1" 2>/dev/null) ]]; }
shard_of() { tr '\0' '\n' <"/proc/$1/cmdline" 2>/dev/null | grep -A1 -x -e --shard | tail -1; }

# Kills one of the program's processes, if there is any.
kill_one() {
    local processes victim parent what=program shard
    mapfile -t processes < <(pgrep -x "$(basename "$program")" | sort -n)
    ((${#processes[@]})) || return 1
    victim=${processes[RANDOM % ${#processes[@]}]}
    shard=$(shard_of "$victim")
    parent=$(awk "/^PPid/ { print \$2 }" "/proc/$victim/status" 2>/dev/null)
    [[ $(cat "/proc/$parent/comm" 2>/dev/null) == fidservo ]] && what=task
    kill -KILL "$victim" 2>/dev/null || return 1
    echo "killed: the $what of shard $shard (${#number_of[@]} results were there)"
}

disturb() {
    local job=$1 killed=0
    while ((killed < kills)) && queued "$job"; do
        sleep "$(drawn 0 2).$(drawn 0 9)"
        look_at_results
        kill_one || continue
        killed=$((killed + 1))
        if ((killed == brief_stop_at)); then
            echo "killed: the node's daemon, and started again at once"
            stop_node
            start_node
            until_true 60 "the node" node_works
        elif ((killed == long_stop_at)); then
            echo "killed: the node's daemon"
            stop_node
            until_true 120 "the controller gives the node up" node_is_down
            echo "started again: the node's daemon, $(pgrep -xc "$(basename "$program")" || true) processes of before still at work"
            start_node
            resume_node
        fi
    done
    ((killed == kills)) || fail "the array ended after $killed kills: its campaigns are too quick"
}

run_as_array() {
    local job begin=$SECONDS
    rm -rf "$folder/many" "$folder/logs"
    mkdir -p "$folder/logs"
    job=$(cd "$folder/logs" && FIDSERVO=$program sbatch --parsable --array=1-$shards%2 "$top/deploy/slurm/fleet.sbatch" \
        "${diagnose[@]}" "$folder"/recordings/*/* --out "$folder/many")
    disturb "$job"
    while queued "$job"; do
        ((SECONDS - begin < limit_s)) || { fail "the array has not ended within $limit_s s" && break; }
        look_at_results
        sleep 1
    done
    look_at_results
    scontrol --oneliner show job "$job" >"$folder/jobs.txt"
    echo "$(grep -c . "$folder/jobs.txt") tasks of the array, begun again $(grep -o 'Restarts=[0-9]*' "$folder/jobs.txt" | awk -F= '{ sum += $2 } END { print sum + 0 }') times, $((SECONDS - begin)) s"
}

compare() {
    local wanted there
    wanted=$((units * weeks))
    there=$(find "$folder/many/results" -type f | wc -l)
    (($(grep -cE 'JobState=(COMPLETED|FAILED) .*ExitCode=[01]:0' "$folder/jobs.txt") == shards)) || fail "not every task of the array came to its end: $folder/jobs.txt"
    ((there == wanted)) || fail "$there files in $folder/many/results, not $wanted"
    [[ ! -e $folder/many/superseded ]] || fail "there are superseded results"
    diff -r "$folder/one/results" "$folder/many/results" || fail "results differ from those of one run"
    ((failures)) || echo "$there results, each made once, byte for byte those of one run"
}

say "$((units * weeks)) campaigns, seed $seed"
write_recordings
say "one run"
run_as_one
say "the cluster"
start_cluster
sinfo
say "an array of $shards shards, two at a time"
run_as_array
say "the results"
compare
exit $((failures ? 1 : 0))
