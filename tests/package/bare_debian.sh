#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# bare_debian.sh PACKAGES FOLDER: installs the packages in a bare Debian 12, made in FOLDER, as a user would who has nothing
# else: the program, with which the demo is inspected; the libraries, against which the examples are built and run; the Python
# module and its examples.
# As root. Nothing outside FOLDER changes; what is mounted is gone when it ends.
set -euo pipefail
(($# == 2)) || { echo "usage: bare_debian.sh PACKAGES FOLDER" >&2 && exit 2; }
packages=$(realpath "$1")
mkdir -p "$2"
folder=$(realpath "$2")
if [[ ${in_namespace:-} != yes ]]; then
    in_namespace=yes exec unshare --mount --propagation private "${BASH_SOURCE[0]}" "$packages" "$folder"
fi

say() { printf '\n== %s\n' "$*"; }

inside() {
    chroot "$folder/debian" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
        LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive bash -euo pipefail -c "$1"
}

say "a bare Debian in $folder/debian"
rm -rf "$folder/debian"
debootstrap --variant=minbase bookworm "$folder/debian" >"$folder/debootstrap.log"
mount -t proc proc "$folder/debian/proc"
cp "$packages"/*.deb "$folder/debian/root/"

say "the program"
begin=$SECONDS
inside 'apt-get update -qq && apt-get install -qq -y --no-install-recommends ~/fidservo_*.deb' >"$folder/install-program.log" 2>&1
printf 'installed in %d s\n' $((SECONDS - begin))
inside 'cd && fidservo inspect /usr/share/fidservo/demo/recipe.yaml --out demo || (($? == 1)); test -s demo/report.html' |
    tail -2
printf 'the first report after %d s\n' $((SECONDS - begin))
inside 'test -e /usr/share/man/man1/fidservo-calibrate-camera.1.gz
    source /usr/share/bash-completion/completions/fidservo
    COMP_WORDS=(fidservo goto --t) COMP_CWORD=2
    _fidservo
    [[ ${COMPREPLY[*]} == --tag ]]'

say "the libraries"
begin=$SECONDS
inside 'apt-get install -qq -y --no-install-recommends make ~/libfidservo-dev_*.deb' >"$folder/install-development.log" 2>&1
printf 'installed in %d s\n' $((SECONDS - begin))
inside 'cp -r /usr/share/doc/fidservo/examples ~/ && cd ~/examples
    cmake -B build >/dev/null && cmake --build build -j "$(nproc)"
    ctest --test-dir build --output-on-failure'

say "the Python module"
begin=$SECONDS
inside 'apt-get install -qq -y --no-install-recommends ~/python3-fidservo_*.deb' >"$folder/install-python.log" 2>&1
printf 'installed in %d s\n' $((SECONDS - begin))
inside 'cd && for example in /usr/share/doc/python3-fidservo/examples/*.py; do
        echo "$example" && python3 "$example" | tail -2
    done'
