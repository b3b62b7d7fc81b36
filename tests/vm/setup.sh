#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# setup.sh DIR: the virtual machine for the device tests. Downloads Debian's kernel without installing it, builds
# v4l2loopback and Comedi's multiq3 driver for it, and leaves DIR/vmlinux and DIR/initrd.gz. Does nothing if they are
# there for this kernel already.
# Needs: busybox-static, cpio, kmod, python3, gcc, make.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
dir=$(realpath -m "${1:?usage: setup.sh DIR}")

image=$(apt-cache depends linux-image-amd64 | awk '/Depends: linux-image/ {print $2; exit}')
release=${image#linux-image-}
stamp="$release $(cat "$here/setup.sh" "$here/init" | sha256sum | cut -c1-16)"
if [[ $(cat "$dir/ready" 2>/dev/null) == "$stamp" ]]; then exit 0; fi

echo "setting up $dir: kernel $release"
rm -rf "$dir"
mkdir -p "$dir/download" "$dir/kernel" "$dir/source"

fetch() {
    local base=${release%-amd64}
    cd "$dir/download"
    apt-get download -q -o APT::Sandbox::User="$(id -un)" "$image" "linux-headers-$base-amd64" \
        "linux-headers-$base-common" "linux-kbuild-${base%%.0-*}" "linux-source-${base%%.0-*}" \
        v4l2loopback-dkms >"$dir/setup.log"
    dpkg -x linux-image-*.deb "$dir/kernel"
    for package in linux-headers-*.deb linux-kbuild-*.deb linux-source-*.deb v4l2loopback-dkms*.deb; do
        dpkg -x "$package" "$dir/source"
    done
    cd "$dir"
    rm -rf "$dir/download"
}

# build_module NAME SOURCE-FOLDER: a module outside the kernel's tree, built in place.
build_module() {
    local headers=$dir/source/usr/src/linux-headers-$release
    sed -i "s#^include /usr/src/#include $dir/source/usr/src/#" "$headers/Makefile"
    make -s -C "$headers" M="$2" KERNELRELEASE="$release" modules >>"$dir/setup.log" 2>&1
    mkdir -p "$dir/kernel/lib/modules/$release/extra"
    cp "$2/$1.ko" "$dir/kernel/lib/modules/$release/extra/"
}

# A driver of the kernel's that Debian does not build: that of the board with which the stage was published.
unpack_multiq3() {
    mkdir -p "$dir/source/multiq3"
    tar -xJf "$dir"/source/usr/src/linux-source-*.tar.xz -C "$dir/source/multiq3" --strip-components=4 \
        --wildcards '*/drivers/comedi/drivers/multiq3.c'
    echo 'obj-m := multiq3.o' >"$dir/source/multiq3/Makefile"
    rm "$dir"/source/usr/src/linux-source-*
}

# qemu starts an unpacked kernel sooner than one that unpacks itself in emulation.
unpack_kernel() {
    python3 - "$dir/kernel/boot/vmlinuz-$release" "$dir/vmlinux" <<'PYTHON'
import lzma, sys
packed = open(sys.argv[1], "rb").read()
start = packed.find(b"\xfd7zXZ\x00")
open(sys.argv[2], "wb").write(lzma.LZMADecompressor().decompress(packed[start:]))
PYTHON
}

# make_initrd MODULE...: busybox, ./init, these modules and what they depend on.
make_initrd() {
    local root modules=lib/modules/$release module file
    root=$(mktemp -d)
    depmod -b "$dir/kernel" "$release"
    mkdir -p "$root"/{bin,dev,proc,sys,mnt,$modules}
    cp /bin/busybox "$root/bin/"
    for applet in sh mount mkdir modprobe chroot cat tr ifconfig sync poweroff; do ln -s busybox "$root/bin/$applet"; done
    for module in "$@"; do
        modprobe -d "$dir/kernel" -S "$release" --show-depends "$module" | awk '$1 == "insmod" {print $2}'
    done | sort -u | while read -r file; do
        file=${file#"$dir/kernel"}
        mkdir -p "$root/$(dirname "$file")"
        cp "$dir/kernel/$file" "$root/$file"
    done
    cp "$dir/kernel/$modules"/modules.{order,builtin} "$root/$modules/"
    depmod -b "$root" "$release" 2>>"$dir/setup.log"
    cp "$here/init" "$root/init"
    (cd "$root" && find . | cpio -o -H newc --quiet | gzip -1) >"$dir/initrd.gz"
    rm -rf "$root"
}

fetch
build_module v4l2loopback "$(echo "$dir"/source/usr/src/v4l2loopback-*)"
unpack_multiq3
build_module multiq3 "$dir/source/multiq3"
unpack_kernel
make_initrd virtio_pci 9pnet_virtio 9p overlay vivid v4l2loopback comedi_test multiq3
echo "$stamp" >"$dir/ready"
