#!/usr/bin/env bash
# the law `linear`, copied outside the tree and built against an installation, beside the built-in one: within LIMIT=1.03
set -euo pipefail
cd "$(dirname "$0")/../.."

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install build --prefix "$work/scree" > /dev/null
mkdir "$work/copy"
sed 's/"linear"/"linear_copy"/' contact_models/linear/linear.cpp > "$work/copy/linear_copy.cpp"
cat > "$work/copy/CMakeLists.txt" << 'TEXT'
cmake_minimum_required(VERSION 3.25)
project(copy CXX)
find_package(scree REQUIRED)
scree_add_plugin(linear_copy KIND contact_model SOURCES linear_copy.cpp)
TEXT
cmake -S "$work/copy" -B "$work/copy/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/scree" > /dev/null
cmake --build "$work/copy/build" > /dev/null
build/bin/scree_bench outside linear_copy "$work/copy/build/plugins" "${LIMIT:-1.03}"
