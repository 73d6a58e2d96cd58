#!/usr/bin/env bash
# A clean Debian in a folder: apt installs the .deb and what it depends on, the program renders, Python imports the module,
# and the consumers in C and C++ are built by find_package and by pkg-config and run. Then the wheel in an environment
# of its own, without the package. clean_system.sh FOLDER, where ./do package and ./do wheel have put both; needs root and
# Debian's mirror, takes minutes.
. "$(dirname "$0")/../support/check.sh"
package=$(ls "$1"/pmdsim_*.deb 2>/dev/null || true)
wheel=$(ls "$1"/pmdsim-*.whl 2>/dev/null || true)
system=$scratch/system
[ -f "$package" ] && [ -f "$wheel" ] || { say 'skipped: ./do package and ./do wheel have made nothing'; exit $skipped; }
need mmdebstrap chroot mount
[ "$(id -u)" -eq 0 ] || { say 'skipped: chroot needs root'; exit $skipped; }

# What is mounted into the system must be gone before the folder is.
unmount() {
  local place
  for place in "$system/proc" "$system/dev"; do
    if mountpoint -q "$place"; then umount -l "$place"; fi
  done
}
trap 'unmount; leave' EXIT

in_system() { chroot "$system" env -i PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive "$@"; }

make_system() {
  if ! mmdebstrap --mode=root --variant=minbase bookworm "$system" >"$scratch/log" 2>&1; then
    say "skipped: mmdebstrap cannot make a system: $(tail -1 "$scratch/log")"
    exit $skipped
  fi
  mount -t proc proc "$system/proc"
  mount --rbind /dev "$system/dev"
  mount --make-rslave "$system/dev"
  cp /etc/resolv.conf "$system/etc/resolv.conf"
  cp "$package" "$wheel" "$system/root/"
}

install_package() {
  in_system apt-get update -qq >"$scratch/log" 2>&1 || fail "apt-get update: $(tail -5 "$scratch/log")"
  in_system apt-get install -y -qq --no-install-recommends "/root/$(basename "$package")" >"$scratch/log" 2>&1 ||
    fail "apt-get install: $(tail -5 "$scratch/log")"
  say 'apt-get install: done'
}

# check_hardening FOLDER: what is installed in a folder of the system is as protected as what was built.
check_hardening() { find "$system$1" \( -name pmdsim -o -name 'libpmdsim.so.0' \) -type f,l -exec "$source_root/tests/package/hardening.sh" {} +; }

use_program() {
  local setup=/usr/share/doc/pmdsim/examples/scenes/analytic/inverse_square.json
  in_system pmdsim --version
  in_system pmdsim devices
  in_system pmdsim render "$setup" -o /root/out >/dev/null
  [ -f "$system/root/out/manifest.json" ] || fail 'render wrote no manifest'
  say 'pmdsim render: done'
}

# use_python PYTHON
use_python() {
  in_system "$1" -c '
import pmdsim
frame = pmdsim.render("/usr/share/doc/pmdsim/examples/scenes/analytic/inverse_square.json")
print("python:", pmdsim.__file__, frame.distance_m.shape, float(frame.distance_m.mean()))'
}

build_consumers() {
  local examples=/usr/share/doc/pmdsim/examples/consumer
  in_system apt-get install -y -qq --no-install-recommends g++ cmake ninja-build pkg-config >"$scratch/log" 2>&1 ||
    fail "apt-get install: $(tail -5 "$scratch/log")"
  in_system sh -euc "
    for language in C CXX; do
      cmake -S $examples -B /root/\$language -G Ninja -DCONSUMER_LANGUAGE=\$language >/dev/null
      cmake --build /root/\$language >/dev/null
      /root/\$language/consumer
    done
    cc $examples/consumer.c -o /root/by_pkg_config \$(pkg-config --cflags --libs pmdsim) -lm
    /root/by_pkg_config
    c++ $examples/consumer.cpp -o /root/by_pkg_config \$(pkg-config --cflags --libs pmdsim)
    /root/by_pkg_config"
  say 'consumers in C and C++ by find_package and pkg-config: done'
}

# The package goes, but not what it pulled in, which the wheel's library needs, too.
use_wheel() {
  in_system apt-get install -y -qq --no-install-recommends python3-venv >"$scratch/log" 2>&1 ||
    fail "apt-get install: $(tail -5 "$scratch/log")"
  in_system cp -r /usr/share/doc/pmdsim /root/pmdsim
  in_system dpkg --remove pmdsim >/dev/null
  in_system cp -r /root/pmdsim /usr/share/doc/
  in_system python3 -m venv --system-site-packages /root/venv
  in_system /root/venv/bin/pip install -q --no-index --no-deps "/root/$(basename "$wheel")"
  check_hardening /root/venv
  use_python /root/venv/bin/python3
  say 'the wheel: done'
}

make_system
install_package
check_hardening /usr/bin
check_hardening /usr/lib
use_program
use_python python3
build_consumers
use_wheel
expect 'what the package left' '' "$(in_system sh -c 'ls /usr/lib/libpmdsim* /usr/bin/pmdsim 2>/dev/null' || true)"
