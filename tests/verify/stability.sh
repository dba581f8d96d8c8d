#!/usr/bin/env bash
# 10 000 random networks against their critical step, and rows of balls, free flights, turns and impacts over 1e6 cycles and more
set -euo pipefail
measured=$(mktemp)
trap 'rm -f "$measured"' EXIT
code=0
SCREE_MEASURED=$measured "${BUILD:-build}/bin/test_stability" '[verify]' || code=$?
cat "$measured"
exit $code
