# Shared by the scripts in this folder; sourced, not run. Sets `root` and moves there.

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

# build PRESET TARGET...: configures and builds; a compiler cache is used when there is one.
build() {
  local preset=$1
  shift
  local cache=()
  if command -v ccache >/dev/null; then
    cache=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  say "configuring preset $preset"
  cmake --preset "$preset" "${cache[@]}" >"$(log configure)" 2>&1 ||
    { cat "$(log configure)" >&2; die "configuring preset $preset failed, see above"; }
  say "building preset $preset: $*"
  cmake --build --preset "$preset" --parallel "$(nproc)" --target "$@" ||
    die "building preset $preset failed, see above"
}

# log NAME: where the output of a step goes that is only worth showing when it fails.
log() {
  mkdir -p "$root/build/log"
  printf '%s/build/log/%s.log' "$root" "$1"
}
