# Shared by the scripts in this folder; sourced, not run. Sets `root` and moves there.

script_file=$(realpath "$0")
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
script=$(basename "$0")
# A command of the operator's locale must not change what the scripts read.
export LC_ALL=C.UTF-8

say() { printf '%s: %s\n' "$script" "$*"; }
die() {
  printf '%s: %s\n' "$script" "$*" >&2
  exit 1
}

# The lines under "usage" at the head of the script.
usage() {
  sed -n '2,/^[^#]/{/^# usage/,/^[^#]/{s/^# \{0,1\}//p}}' "$script_file" >&2
  exit 2
}

# configure PRESET [CMAKE-OPTION...]: a compiler cache is used when there is one.
configure() {
  local cache=()
  if command -v ccache >/dev/null; then
    cache=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    # What ccache asks for where headers are precompiled.
    export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}
  fi
  say "configuring preset $*"
  cmake --preset "$@" "${cache[@]}" >"$(log "configure-$1")" 2>&1 ||
    { cat "$(log "configure-$1")" >&2; die "configuring preset $1 failed, see above"; }
}

# build PRESET TARGET...: configures and builds.
build() {
  local preset=$1
  shift
  configure "$preset"
  say "building preset $preset: $*"
  cmake --build --preset "$preset" --parallel "$(nproc)" --target "$@" ||
    die "building preset $preset failed, see above"
}

# program PRESET NAME: the file that the build has made; what CPack has copied of it lies in package/.
program() { find "build/$1" -path "build/$1/package" -prune -o -type f -name "$2" -perm -u+x -print; }

# log NAME: where the output of a step goes that is only worth showing when it fails.
log() {
  mkdir -p "$root/build/log"
  printf '%s/build/log/%s.log' "$root" "$1"
}

# packages RELEASE: the names of tools/packages.txt that this release of Debian needs, by its code name.
packages() {
  awk -v release="$1" '
    { sub(/#.*/, "") }
    NF == 0 { next }
    NF == 1 { print $1; next }
    { for (i = 2; i <= NF; ++i) if ($i == release) print $1 }' "$root/tools/packages.txt"
}

# debian_sources RELEASE: this machine's own sources of Debian packages, for another release, as lines for apt.
debian_sources() {
  local sources
  sources=$(apt-get indextargets --format '$(SITE) $(CODENAME)' \
              'Created-By: Packages' 'Origin: Debian' 'Component: main' |
    sed -E "s/^(\S+) [a-z]+(.*)/deb \1 $1\2 main/" | sort -u)
  [ -n "$sources" ] || die "apt knows no source of Debian packages yet: run apt-get update, or name a mirror with --mirror"
  printf '%s\n' "$sources"
}
