#!/usr/bin/env bash
# error against run time: fitted orders of six studies against their bands, tables and pictures into docs/study.md
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/../.."

build=${BUILD:-build} page=${PAGE:-docs/study.md}
pictures=$(dirname "$page")/study
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$pictures"
failed=0

{
  cat << 'TEXT'
# Error against run time, measured

What `scree study` finds for cases whose order is known; `./dev verify study` runs the scenes of `tests/verify/study` on one thread and
writes this page. Leapfrog is of order 2 where forces are smooth; 2.5 is what the speed after an impact by Hertz's law shows, as its force begins with the power 1.5 of the overlap; 1 where
a dashpot's force jumps at touch. An impact is better or worse with the phase of the step in which it begins, so the scenes of impacts hold pairs at many phases and measure
the worst of them. How each figure is found: [cli.md](cli.md#error-against-run-time).

Wall times depend on the machine and on what else it does; contact updates do not. The wave here runs in a row with free ends: with the quiet boundaries of
`examples/problems/p12_wave/wave.yaml`, which are dashpots, the same study finds order 1.
TEXT
} > "$work/page"

# study NAME SCENE WORDS -- QUANTITY LOW HIGH [QUANTITY LOW HIGH]...
study() {
  local name=$1 scene=tests/verify/study/$2 words=()
  shift 2
  while [ "$1" != -- ]; do words+=("$1") && shift; done
  shift
  local out=$work/$name begun=$EPOCHREALTIME
  if ! "$build/bin/scree" study "$scene" "${words[@]}" -j 1 -o "$out" > "$work/log" 2>&1; then
    echo "$scene: the study failed" >&2
    tail -n 5 "$work/log" >&2
    failed=1
    return
  fi
  local took
  took=$(awk -v a="$begun" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.1f", b - a }')
  {
    printf '\n## %s\n\n' "$(sed -n 's/^title: //p' "$scene")${words[*]:+, with \`${words[*]}\`}"
    echo "\`scree study $scene${words[*]:+ ${words[*]}} -j 1\`, $took s in all."
    echo
    while [ $# -ge 3 ]; do
      local order
      order=$(sed -n "s/^$1: order \([-0-9.]*\).*/\1/p" "$work/log")
      if awk -v o="$order" -v low="$2" -v high="$3" 'BEGIN { exit !(o != "" && o >= low && o <= high) }'; then
        echo "* order of $1: $order, wanted $2 to $3"
        echo "$name: order of $1 $order, wanted $2 to $3, $took s" >&2
      else
        echo "* order of $1: ${order:-none}, wanted $2 to $3: **outside**"
        echo "$name: order of $1 is ${order:-none}, wanted $2 to $3" >&2
        failed=1
      fi
      shift 3
    done
    echo
    sed -n '3p' "$out/study.md"
    echo
    # What follows the sentence, down to the picture; headings of its own and paths of this machine are not for the page.
    sed -n '5,$p' "$out/study.md" | sed "s|(study.svg)|(study/$name.svg)|; s|$work/||g"
  } >> "$work/page"
  [ -f "$out/study.svg" ] && cp "$out/study.svg" "$pictures/$name.svg"
}

study co1 co1_pairs.yaml -- trajectory 1.8 2.2 least_peak 1.8 2.2 restitution 2.3 2.7
study c3 c3_drops.yaml -- restitution 0.75 1.25
study p01 p01_dynamic.yaml -- trajectory 1.8 2.2 rotation 1.8 2.2 tip 1.8 2.2
study p12 p12_pulse.yaml -- trajectory 1.8 2.2 balls.38.velocity.x 1.8 2.2
# The automatic step and its nearest are better than their order there: contacts last whole numbers of steps.
study box box_30.yaml --rungs 13 -- trajectory 1.8 2.2
study box_dashpots box_30.yaml --set vars.damping=0.1 --rungs 13 -- trajectory 0.75 1.25

mv "$work/page" "$page"
echo "$page written$([ $failed -eq 0 ] || echo '; not all orders are within their bands')"
exit $failed
