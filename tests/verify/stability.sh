#!/usr/bin/env bash
# 10 000 random networks against their critical step, and rows of balls along (1,1,1) for 1e6 cycles
set -euo pipefail
measured=$(mktemp)
trap 'rm -f "$measured"' EXIT
code=0
SCREE_MEASURED=$measured "${BUILD:-build}/bin/test_stability" '[verify]' || code=$?
cat "$measured"
exit $code
