#!/usr/bin/env bash
# usage: setup.sh [PRESET [TARGET...]]
# Installs the Debian packages that are missing (and says which before it does), then builds the
# targets of the preset (release) in CMakePresets.json; all of them if none is given. Needs root
# only to install.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

. scripts/debian_packages.sh
install_missing g++ cmake ninja-build pkg-config libsystemc-dev libglm-dev libopenexr-dev catch2 \
  libcli11-dev libcereal-dev nlohmann-json3-dev libfmt-dev libpng-dev libjpeg62-turbo-dev libtiff-dev libwebp-dev \
  libtbb-dev libnanoflann-dev libboost-dev libxxhash-dev libzip-dev libzstd-dev zlib1g-dev xz-utils python3

preset=${1:-release}
targets=("${@:2}")
[ -f "build/$preset/build.ninja" ] || cmake --preset "$preset"
cmake --build --preset "$preset" ${targets:+--target "${targets[@]}"}
