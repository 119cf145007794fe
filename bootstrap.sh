#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# From a fresh clone to pictures or test results with one command. See `bash bootstrap.sh help`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

readonly package_list=third_party/apt-packages.txt
readonly build_folder=build/release
readonly program=$build_folder/vernier
readonly assimp_models=/usr/share/assimp/models

say() { printf '%s\n' "$*"; }
fail() { printf 'bootstrap: %s\n' "$*" >&2; exit 1; }

usage() {
  cat <<'HELP'
usage: bash bootstrap.sh COMMAND

  deps    install the Debian or Ubuntu packages of third_party/apt-packages.txt that are missing
  build   deps, then configure and build the program: build/release/vernier
  demo    build, then render scenes into out/, with a page that shows them: out/index.html
  test    deps, then build the program and its tests, and run them all
  package deps, then build a Debian package for any x86-64-v2 processor and faster ones: build/package/package/*.deb
  help    this text

Each command can be run again at any time and only does what is left to do.
Environment: JOBS=N parallel jobs; VERNIER_WERROR=ON treats compiler warnings as errors.
HELP
}

# Processors, but no more than one job for each 1.5 GB of memory.
job_count() {
  local processors gigabytes
  processors=$(nproc)
  gigabytes=$(awk '/^MemTotal/ { print int($2 / 1.5e6) }' /proc/meminfo)
  ((gigabytes >= 1)) || gigabytes=1
  say "${JOBS:-$((processors < gigabytes ? processors : gigabytes))}"
}

# --- deps ---

# Names of the list's packages; "required" or "optional" ones (those whose comment begins with "optional").
listed_packages() {
  local optional=0
  [[ $1 == optional ]] && optional=1
  awk -v wanted=$optional '/^[a-z0-9]/ { if (($2 == "#" && $3 ~ /^optional/) == wanted) print $1 }' "$package_list"
}

is_installed() { [[ $(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]; }

missing_packages() {
  local package
  for package in $(listed_packages "$1"); do
    is_installed "$package" || say "$package"
  done
}

as_root() {
  if ((EUID == 0)); then "$@"; else sudo "$@"; fi
}

deps() {
  command -v apt-get >/dev/null && command -v dpkg-query >/dev/null ||
    fail "this is no Debian or Ubuntu; install what $package_list lists by other means, then use cmake --preset release"
  local required optional package install
  mapfile -t required < <(missing_packages required)
  mapfile -t optional < <(missing_packages optional)
  if ((${#required[@]} > 0)); then
    ((EUID == 0)) || command -v sudo >/dev/null ||
      fail "run this as root or install sudo; missing: ${required[*]}"
    as_root apt-get update -qq
  fi
  install=("${required[@]}")
  for package in "${optional[@]}"; do
    if apt-cache show "$package" >/dev/null 2>&1; then
      install+=("$package")
    else
      say "deps: this distribution has no $package; going on without it"
    fi
  done
  if ((${#install[@]} == 0)); then
    say "deps: every package is there"
    return
  fi
  say "deps: installing ${install[*]}"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q -o DPkg::Lock::Timeout=600 \
    --no-install-recommends "${install[@]}"
}

# --- build ---

# What was chosen before stays when nothing is said, so that nothing is built anew.
configure() { cmake --preset release ${VERNIER_WERROR:+-DVERNIER_WERROR="$VERNIER_WERROR"}; }

build() {
  deps
  configure
  cmake --build "$build_folder" --parallel "$(job_count)" --target "$@"
}

# --- demo ---

# picture NAME SCENE [OPTION...]: out/NAME.png
picture() { "$program" render "$2" -o "out/$1.png" "${@:3}"; }

picture_with_each_integrator() {
  local name=$1 integrator
  shift
  for integrator in $("$program" render --integrator help | awk '{ print $1 }'); do
    picture "$name-$integrator" "$@" --integrator "$integrator"
  done
}

demo() {
  build vernier_launcher
  mkdir -p out
  SECONDS=0
  local engine=$assimp_models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb
  local shown=(out/still_life.png out/night_room.png)
  picture still_life tests/scenes/still_life.gltf --size 800x450 --spp 48 --fstop 8 --denoise nlm
  picture night_room tests/scenes/night_room.gltf --size 800x450 --spp 48 --denoise nlm
  if [[ -f $engine ]]; then
    picture engine "$engine" --size 640x480 --spp 32 --azimuth 35 --elevation 20 --ground matte --denoise nlm
    shown+=(out/engine.png)
  else
    say "demo: the package assimp-testmodels is not there; only our own scenes are rendered"
  fi
  picture layers.### tests/scenes/layer_spheres.gltf --size 400x160 --spp 16 --env studio --turntable 12
  picture_with_each_integrator cornell_box tests/scenes/cornell_box.gltf --size 320x320 --spp 64
  picture_with_each_integrator two_spheres tests/scenes/two_spheres.gltf --size 400x300 --spp 64
  say "demo: rendered in $SECONDS s"
  "$program" verify tests/scenes/cornell_box.gltf
  "$program" verify tests/scenes/two_spheres.gltf
  "$program" gallery "${shown[@]}" out/layers.*.png out/cornell_box-*.png out/two_spheres-*.png -o out/index.html \
    --title "What Vernier renders"
  say "demo: the pictures and $PWD/out/index.html, a page of them all:"
  ls -1 out
}

# --- test ---

run_tests() {
  build all
  ctest --test-dir "$build_folder" --parallel "$(job_count)" --output-on-failure --no-tests=error
}

# --- package ---

# build_for LEVEL FOLDER [OPTION...]: the program for a level of processor.
build_for() {
  local level=$1 folder=$2
  shift 2
  cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DVERNIER_TESTS=OFF \
    -DVERNIER_MARCH="$level" "$@"
  cmake --build "$folder" --parallel "$(job_count)"
}

package() {
  deps
  if [[ $(uname -m) == x86_64 ]]; then
    build_for x86-64-v3 build/package-x86-64-v3
    build_for x86-64-v2 build/package -DVERNIER_OTHER_BUILDS="$PWD/build/package-x86-64-v3"
  else
    build_for "" build/package
  fi
  cpack --config build/package/CPackConfig.cmake
}

case "${1:-help}" in
  deps) deps ;;
  build) build vernier_launcher && say "build: the program is $PWD/$program" ;;
  demo) demo ;;
  test) run_tests ;;
  package) package ;;
  help | -h | --help) usage ;;
  *)
    usage >&2
    exit 2
    ;;
esac
