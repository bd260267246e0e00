# What the scripts share: a way to say what went wrong, packages, configuring, building.
# Sourced by run, test and bench after `set -euo pipefail`; sets `root` and goes there. Needs bash alone.
# shellcheck shell=bash

root=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)
cd "$root" || exit 1

# say SENTENCE…: talk goes to stderr.
say() {
  printf '%s\n' "$*" >&2
}

# die SENTENCE…: says why and ends with 1.
die() {
  say "scripts/$(basename "$0"): error: $*"
  exit 1
}

# packagesOf LIST: the names in one list of scripts/packages, one a line.
packagesOf() {
  awk -v wanted="[$1]" '/^\[/ { open = ($1 == wanted); next } open && NF && !/^#/ { print $1 }' scripts/packages
}

# missingPackages NAME…: those that dpkg does not count as installed, one a line.
missingPackages() {
  local installed
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null |
    awk '$1 == "installed" { print $2 }') || true
  comm -23 <(printf '%s\n' "$@" | sort -u) <(sort -u <<<"$installed")
}

# installPackages LIST…: installs what is missing from the named lists; asks nothing, does nothing where all is there.
installPackages() {
  local list wanted=() missing sudo=()
  for list in "$@"; do mapfile -t -O "${#wanted[@]}" wanted < <(packagesOf "$list"); done
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    die "this script installs Debian 12 packages with apt-get, which this machine lacks. Install what" \
      "scripts/packages names in your own way, then: cmake --preset release && cmake --build --preset release"
  fi
  mapfile -t missing < <(missingPackages "${wanted[@]}")
  if [[ ${#missing[@]} -eq 0 ]]; then return; fi
  if [[ $(id -u) -ne 0 ]]; then
    command -v sudo >/dev/null ||
      die "installing needs root or sudo, and this user has neither. Missing: ${missing[*]}"
    sudo=(sudo)
  fi
  say "installing ${missing[*]}"
  local apt=("${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0)
  "${apt[@]}" update </dev/null >&2 || die "apt-get update failed"
  "${apt[@]}" install -y --no-install-recommends "${missing[@]}" </dev/null >&2 ||
    die "apt-get could not install: ${missing[*]}"
}

# buildJobs: how many compilers at once: one a core, and 1.5 GB of free memory for each (OpenVDB's headers take that).
buildJobs() {
  local cores byMemory
  cores=$(nproc)
  byMemory=$(awk '/^MemAvailable:/ { print int($2 / 1500000) }' /proc/meminfo)
  echo $((byMemory < 1 ? 1 : byMemory < cores ? byMemory : cores))
}

# build PRESET [TARGET…]: configures where that was not done yet (ninja sees later changes itself), then builds.
build() {
  local preset=$1 folder=build targets=()
  shift
  if [[ $preset != release ]]; then folder=build-$preset; fi
  if [[ ! -f $folder/build.ninja || CMakePresets.json -nt $folder/build.ninja ]]; then
    cmake --preset "$preset" >&2 || die "cmake could not configure the preset '$preset' (see above)"
  fi
  if [[ $# -gt 0 ]]; then targets=(--target "$@"); fi
  cmake --build --preset "$preset" -j "$(buildJobs)" "${targets[@]}" >&2 ||
    die "the build in $folder/ failed (see above)"
}
