#!/usr/bin/env bash
# debian_package.sh BUILD FOLDER CONSUMER COMPILER: makes the Debian package of the build folder BUILD, unpacks it as dpkg would
# into FOLDER, and lets the project CONSUMER find it there.
set -euo pipefail
build=$1 folder=$2 consumer=$3 compiler=$4
if ! command -v dpkg-deb >/dev/null; then
  echo "skipped: no dpkg-deb here"
  exit 0
fi
rm -rf "$folder"
mkdir -p "$folder"
(cd "$build" && cpack -B "$folder/package" >/dev/null)
package=$(echo "$folder"/package/libcambium-dev_*.deb)
dpkg-deb --field "$package" Package Version Architecture Depends
[[ $(dpkg-deb --field "$package" Depends) == *libeigen3-dev*libboost-dev* ]]
dpkg-deb --extract "$package" "$folder/root"
[[ -e $folder/root/usr/include/cambium/cambium.hpp ]]
cmake -S "$consumer" -B "$folder/consumer" "-DCMAKE_CXX_COMPILER=$compiler" "-DCMAKE_PREFIX_PATH=$folder/root/usr" \
  -DCONSUMER_COMPONENTS=opendrive -DCONSUMER_TARGETS=geometry
cmake --build "$folder/consumer"
cd "$folder/consumer" && ctest --output-on-failure
if [[ $(id -u) == 0 ]]; then # with dpkg itself, into a root of its own
  mkdir -p "$folder/system/var/lib/dpkg/updates"
  touch "$folder/system/var/lib/dpkg/status"
  dpkg --root="$folder/system" --force-depends --force-not-root -i "$package" >/dev/null 2>&1
  dpkg --root="$folder/system" --verify libcambium-dev
fi
