#!/usr/bin/env bash
# libFuzzer with address and undefined-behaviour sanitizers on the scene reader, from the broken scenes; SECONDS_EACH=60
set -euo pipefail
cd "$(dirname "$0")/../.."
out=build-fuzz
mkdir -p $out/corpus
flags="-std=c++20 -O1 -g -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -I. -Isdk/include -Itests"
flags+=' -DSCREE_VERSION="fuzz" -DSCREE_PLUGIN_DIR="lib/scree/plugins" -DSPDLOG_COMPILED_LIB -DSPDLOG_FMT_EXTERNAL'
sources=(core/scene/*.cpp core/plugin/*.cpp core/base/*.cpp tests/unit/scene_fakes.cpp tests/fuzz/scene_fuzz.cpp)
printf '%s\n' "${sources[@]}" | xargs -P "$(nproc)" -I{} sh -c \
  'clang++ $0 -c "$1" -o "$2/$(echo "$1" | tr / _).o"' "$flags" {} $out 2> $out/compile.log || { cat $out/compile.log; exit 1; }
clang++ -fsanitize=fuzzer,address,undefined $out/*.o -o $out/scene_fuzz \
  -lyaml-cpp -lmuparser -ludunits2 -lcrypto -lspdlog -lfmt -ldl -pthread
LSAN_OPTIONS=suppressions=tests/verify/lsan.supp:print_suppressions=0 \
  $out/scene_fuzz -max_total_time="${SECONDS_EACH:-60}" -timeout=10 -rss_limit_mb=4096 -print_final_stats=1 \
  -artifact_prefix=$out/ $out/corpus tests/scenes_broken
