#!/usr/bin/env bash
# bytes per ball, contacts included: the slope of peak memory between two sizes of the dense packing
set -euo pipefail
bench=build/bin/scree_bench limit=${LIMIT:-560}
read -r small_balls small_bytes < <($bench memory 64000)
read -r large_balls large_bytes < <($bench memory 256000)
awk -v a="$small_balls" -v b="$small_bytes" -v c="$large_balls" -v d="$large_bytes" -v limit="$limit" 'BEGIN {
  slope = (d - b) / (c - a)
  printf "%d balls %d bytes, %d balls %d bytes: %.0f bytes per ball (limit %d)\n", a, b, c, d, slope, limit
  exit slope > limit
}'
