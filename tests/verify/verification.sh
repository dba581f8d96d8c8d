#!/usr/bin/env bash
# the verification cases: value, reference, difference and run time of each into docs/verification.md
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/../.."

build=${BUILD:-build} page=${PAGE:-docs/verification.md}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
rows=$work/rows
failed=0

# Scenes: what the program itself reports in summary.json.
for scene in tests/scenes/*.yaml examples/problems/*/*.yaml; do
  name=$(basename "$scene" .yaml)
  # The folders of the classic problems begin with their numbers.
  case $scene in examples/*) name=$(basename "$(dirname "$scene")" | sed 's/_.*//')_$name ;; esac
  code=0
  "$build/bin/scree" run "$scene" -o "$work/$name" --quiet > "$work/log" 2>&1 || code=$?
  if [ "$code" -ne 0 ]; then
    echo "$scene: exit code $code" >&2
    tail -n 5 "$work/log" >&2
    failed=1
  fi
  [ -f "$work/$name/summary.json" ] || continue
  jq -r --arg name "$name" '.wall_time as $seconds | .expectations[] | select(.equals != null)
    | [$name, .quantity, .value, .equals, .tolerance, $seconds, .source] | @tsv' "$work/$name/summary.json" >> "$rows"
done

# Tests: the lines that support/measure.hpp prints.
if ! "$build/bin/test_scenes" '~every verification scene*' > "$work/tests" 2>&1; then
  grep -v '^MEASURE' "$work/tests" >&2 || true
  failed=1
fi
sed -n 's/^MEASURE\t//p' "$work/tests" >> "$rows"

{
  cat << 'TEXT'
# Verification

Cases with a known answer, each as a scene in `tests/scenes` or `examples/problems` or as a test in `tests/scenes`. `./dev verify` runs them all and writes this page.
A scene's rows are the `expect` entries of its `summary.json` that have a value; the other rows come from tests that need many runs. The
time is that of the run in seconds, for tests since the row before; 0 means that the row was read off an earlier run.
How the error falls with the step, and what it costs, is in [study.md](study.md).

| case | quantity | value | reference | difference | tolerance | time | source |
|---|---|---|---|---|---|---|---|
TEXT
  awk -F '\t' '{
    for (k = 1; k <= NF; ++k) gsub(/\|/, "\\|", $k)
    difference = $3 - $4
    if (difference < 0) difference = -difference
    verdict = difference <= $5 ? "" : " **outside**"
    printf "| %s | %s | %.10g | %.10g | %.2g%s | %.2g | %.3g | %s |\n", $1, $2, $3, $4, difference, verdict, $5, $6, $7
  }' "$rows"
} > "$work/page"
mv "$work/page" "$page"
echo "$page: $(wc -l < "$rows") values$([ $failed -eq 0 ] || echo ', not all within their tolerance')"
exit $failed
