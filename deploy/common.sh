# Shared by ./demo and ./test; sourced, with $root set to the repository.
# FRAMEWATCH_BUILD: where build directories go (default: build/ in the repository).
# FRAMEWATCH_JOBS: parallel jobs (default: the processors).
build_root=${FRAMEWATCH_BUILD:-$root/build}
jobs=${FRAMEWATCH_JOBS:-$(nproc)}

say() { printf '== %4d s  %s\n' "$SECONDS" "$*" >&2; }

# install_packages <--yes or empty> [--with NAME]...: what a build needs, or exit 2.
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
  # In CI nobody looks at variables, and nobody compiles one source alone: who does, at a desk, sees a
  # missing #include.
  local flags=()
  [ -z "${CI:-}" ] || flags=(-DCMAKE_CXX_FLAGS_DEBUG="-Og -g1" -DFRAMEWATCH_JOIN=ON)
  # Debian 13 has no clang 14, which the preset names.
  [ "$preset" != fuzz ] || command -v clang++-14 >/dev/null || flags+=(-DCMAKE_CXX_COMPILER=clang++)
  (cd "$root" && cmake --preset "$preset" -B "$build_root/$preset" "${flags[@]}" >/dev/null) &&
    cmake --build "$build_root/$preset" -j "$jobs" --target "$@"
}
