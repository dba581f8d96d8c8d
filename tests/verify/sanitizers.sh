#!/usr/bin/env bash
# the whole suite under the address, undefined-behaviour and thread sanitizers
set -euo pipefail
cd "$(dirname "$0")/../.."

# The thread sanitizer's memory map does not bear the address randomisation of newer Linux versions.
fixed=()
setarch -R true 2> /dev/null && fixed=(setarch -R)
export ASAN_OPTIONS=${ASAN_OPTIONS:-detect_stack_use_after_return=1:strict_string_checks=1}
export LSAN_OPTIONS=${LSAN_OPTIONS:-suppressions=$PWD/tests/verify/lsan.supp:print_suppressions=0}
export UBSAN_OPTIONS=${UBSAN_OPTIONS:-print_stacktrace=1:halt_on_error=1}
export TSAN_OPTIONS=${TSAN_OPTIONS:-halt_on_error=1:second_deadlock_stack=1}

for preset in ${SANITIZERS:-asan tsan}; do
  echo "== $preset"
  cmake --preset "$preset" -DSCREE_BENCH=OFF --log-level=WARNING > /dev/null
  "${fixed[@]}" cmake --build --preset "$preset"
  "${fixed[@]}" ctest --test-dir "build-$preset" --output-on-failure -j "$(nproc)" --timeout 1800 "$@"
done
