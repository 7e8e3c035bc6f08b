# Shared by ./demo and ./test; sourced, with $root set to the repository.
# FRAMEWATCH_BUILD: directory of the build directories (default: build/ in the repository).
# FRAMEWATCH_JOBS: parallel jobs (default: the number of processors).
build_root=${FRAMEWATCH_BUILD:-$root/build}
jobs=${FRAMEWATCH_JOBS:-$(nproc)}

say() { printf '== %4d s  %s\n' "$SECONDS" "$*" >&2; }

# install_packages <--yes or empty> [--with NAME]...: installs what a build needs, or exits with 2.
install_packages() {
  "$root/deploy/install-deps" ${1:+"$1"} "${@:2}" >&2 || exit 2
}

# warn_missing_packages [--with NAME]...
warn_missing_packages() {
  local missing
  missing=$("$root/deploy/install-deps" --check "$@") ||
    say "not installing these missing packages: $(tr '\n' ' ' <<<"$missing")"
}

use_ccache() {
  if command -v ccache >/dev/null && [ -w "${CCACHE_DIR:-${HOME:-/nonexistent}}" ]; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache
  fi
}

# build_preset <preset> <target>...: configures and builds build/<preset>.
build_preset() {
  local preset=$1
  shift
  if ! mkdir -p "$build_root/$preset" || [ ! -w "$build_root/$preset" ]; then
    say "cannot write $build_root/$preset; set FRAMEWATCH_BUILD to a directory of your own"
    return 1
  fi
  use_ccache
  local flags=()
  # The preset names clang 14, which Debian 13 does not have.
  [ "$preset" != fuzz ] || command -v clang++-14 >/dev/null || flags+=(-DCMAKE_CXX_COMPILER=clang++)
  (cd "$root" && cmake --preset "$preset" -B "$build_root/$preset" "${flags[@]}" >/dev/null) &&
    cmake --build "$build_root/$preset" -j "$jobs" --target "$@"
}
