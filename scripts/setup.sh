#!/usr/bin/env bash
# usage: setup.sh [PRESET [TARGET...]]
# Installs the Debian packages that are missing (and says which before it does), then builds the
# targets of the preset (release) in CMakePresets.json; all of them if none is given. Needs root
# only to install.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(g++ cmake ninja-build pkg-config libsystemc-dev libglm-dev libopenexr-dev catch2
  libcli11-dev libcereal-dev nlohmann-json3-dev libfmt-dev libpng-dev libjpeg62-turbo-dev
  libtbb-dev libnanoflann-dev zlib1g-dev xz-utils python3 python3-matplotlib)
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  echo "installing missing Debian packages: ${missing[*]}"
  as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "not root, and no sudo: install them and try again" >&2; exit 1; }
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq "${missing[@]}"
fi

preset=${1:-release}
targets=("${@:2}")
[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset"
cmake --build --preset "$preset" ${targets:+--target "${targets[@]}"}
