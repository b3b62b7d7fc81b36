#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# fidservo fleet as shards by GNU parallel, on this machine or, with SSHLOGINFILE, on several that share the disk:
#
#   SHARDS=16 deploy/parallel/fleet.sh diagnose --rig rig.yaml recordings/*/* --out fleet
#   SHARDS=64 SSHLOGINFILE=hosts.txt deploy/parallel/fleet.sh replay photos/ --out tags
#
# A shard that was killed or left something undone is tried again, three times in all; one that is done, though some
# of its campaigns failed (exit code 1), is not. Exit code: the number of shards that are not done.
set -euo pipefail
fidservo=${FIDSERVO:-fidservo}
where=()
[[ -n ${SSHLOGINFILE:-} ]] && where=(--sshloginfile "$SSHLOGINFILE" --workdir .)
command=$(printf '%q ' "$fidservo" fleet "$@")
seq 1 "${SHARDS:-16}" | parallel --will-cite "${where[@]}" --retries 3 --line-buffer --tagstring 'shard {}:' \
    "$command --shard {}/${SHARDS:-16} --jobs 1; code=\$?; [ \$code -le 1 ]"
