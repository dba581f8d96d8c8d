#!/usr/bin/env bash
# run_guide.sh GUIDE PREFIX FOLDER: what docs/plugins.md tells its reader to write and to type, done to the letter in an empty
# folder, with an installation as ~/scree and nothing else.
set -euo pipefail
guide=$1 prefix=$2 folder=$3
rm -rf "$folder"
mkdir -p "$folder/home" "$folder/work"
ln -s "$prefix" "$folder/home/scree"
cd "$folder/work"

# ```cpp file=NAME is a file, ```sh run is typed; a plain ```cpp that begins with #include must compile.
awk '
  /^```[a-z]+ file=/ { out = $0; sub(/.*file=/, "", out); folder = out
                       if (sub(/\/[^\/]*$/, "", folder)) system("mkdir -p " folder); next }
  /^```sh run$/ { out = "../steps.sh"; next }
  /^```cpp$/ { out = "../snippet" ++snippets ".cpp"; next }
  /^```/ { out = ""; next }
  out != "" { print > out }' "$guide"
for name in springs/hysteretic.cpp springs/CMakeLists.txt bounce.yaml ../steps.sh; do
  [ -s "$name" ] || { echo "the guide has no $name"; exit 1; }
done
env -i HOME="$folder/home" PATH="/usr/local/bin:/usr/bin:/bin" LANG=C.UTF-8 \
  ${SCREE_CCACHE:+CMAKE_CXX_COMPILER_LAUNCHER="$SCREE_CCACHE"} ${CCACHE_DIR:+CCACHE_DIR="$CCACHE_DIR"} bash -ex ../steps.sh

compiled=0
for snippet in ../snippet*.cpp; do
  head -1 "$snippet" | grep -q '^#include' || continue
  g++ -std=c++20 -Wall -Wextra -Werror -fopenmp-simd -fsyntax-only -I"$prefix/include" "$snippet"
  compiled=$((compiled + 1))
done
[ $compiled -ge 5 ] || { echo "only $compiled examples of the guide were compiled"; exit 1; }
