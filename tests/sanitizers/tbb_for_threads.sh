#!/usr/bin/env bash
# tbb_for_threads.sh DIR: DIR/libtbb.so.12 with ThreadSanitizer, from Debian's source of the version that is installed.
# ThreadSanitizer sees no order of threads that a library without it keeps, so that each of TBB's loops looks like a race.
set -euo pipefail
mkdir -p "$1"
folder=$(cd "$1" && pwd)
[ ! -e "$folder/libtbb.so.12" ] || exit 0
if ! command -v apt-get >/dev/null; then
  echo "tbb_for_threads.sh: no apt-get, so no TBB with ThreadSanitizer: its loops will look like races" >&2
  exit 0
fi

# The system's own sources of packages, as sources of their source; the system's lists stay as they are.
mkdir -p "$folder"/apt/{parts,lists/partial}
touch "$folder/apt/sources.list"
for file in /etc/apt/sources.list /etc/apt/sources.list.d/*; do
  [ -f "$file" ] || continue
  sed -E 's/^Types:.*/Types: deb-src/; s/^deb /deb-src /' "$file" >"$folder/apt/parts/$(basename "$file")"
done
[ ! -f "$folder/apt/parts/sources.list" ] || mv "$folder/apt/parts/sources.list" "$folder/apt/sources.list"
apt=(apt-get -qq -o "Dir::Etc::sourcelist=$folder/apt/sources.list" -o "Dir::Etc::sourceparts=$folder/apt/parts"
  -o "Dir::State::lists=$folder/apt/lists")
cd "$folder"
"${apt[@]}" update || true # some may have no source
"${apt[@]}" source --download-only "$(dpkg-query -W -f '${source:Package}=${source:Version}' libtbb-dev)"

mkdir -p source
tar -xf ./*.orig.tar.* -C source --strip-components 1
cmake -S source -B build -G Ninja -DTBB_TEST=OFF -DTBB_STRICT=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DCMAKE_CXX_FLAGS="-fsanitize=thread -fno-omit-frame-pointer" >/dev/null
ninja -C build tbb >/dev/null
cp -L build/*/libtbb.so.12 "$folder/libtbb.so.12.new"
mv "$folder/libtbb.so.12.new" "$folder/libtbb.so.12"
