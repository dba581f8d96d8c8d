#!/usr/bin/env bash
# scree and other codes in turns on one core: rates in the chute of tests/peers, work and precision of its impact (docs/peers.md)
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/../peers"

parts=${PARTS:-chute impact}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

median() { sort -g | awk '{v[NR]=$1} END{print NR%2 ? v[(NR+1)/2] : (v[NR/2]+v[NR/2+1])/2}'; }

chute() {
  local n=${N:-32000} warm=${WARM:-100} steps=${STEPS:-800} pairs=${PAIRS:-5} rows=$work/chute k peer
  ./run.sh prep chute
  for ((k = 1; k <= pairs; k++)); do
    for peer in scree lammps; do
      ./run.sh one $peer chute "$n" "$warm" "$steps" | tee -a "$rows"
    done
  done
  rate() { awk -v p="$1" '$1==p{print $6}' "$rows"; }
  printf '\nchute, %s balls, %s steps, median of %s pairs\n' "$n" "$steps" "$pairs"
  for peer in scree lammps; do printf '%-8s %12.0f ball-steps/s\n' $peer "$(rate $peer | median)"; done
  printf '%-8s %12.3f scree over lammps, median of the pairs\n' ratio \
    "$(paste <(rate scree) <(rate lammps) | awk '{print $1/$2}' | median)"
}

# What the table and the picture call a code, and the command that says whether it is there.
name_of() { case $1 in scree) echo scree ;; lammps) echo LAMMPS ;; liggghts) echo LIGGGHTS ;; yade) echo YADE ;; esac; }
program_of() { case $1 in lammps) echo lmp ;; *) echo "$1" ;; esac; }

# Rows "code steps_per_contact round seconds error" of all rounds.
measure_impacts() {
  local round n peer line
  for ((round = 1; round <= rounds; round++)); do
    for n in 10 20 50 100 200 500; do
      for peer in "${peers[@]}"; do
        line=$(./impact.sh one "$peer" "$balls" "$n")
        echo "$line"
        awk -v r="$round" '{print $1,$3,r,$5,$6}' <<< "$line" >> "$rows"
      done
    done
  done
}

# "steps_per_contact code median least most error ratio", sorted as the table wants it; ratio: the median over the rounds
# of the code's time over that of scree in the same round.
condense() {
  awk -v peers="${peers[*]}" '
    function middle(a, n,   i, j, t) {
      for (i = 2; i <= n; ++i) for (j = i; j > 1 && a[j] < a[j-1]; --j) { t = a[j]; a[j] = a[j-1]; a[j-1] = t }
      return n % 2 ? a[(n+1)/2] : (a[n/2] + a[n/2+1])/2
    }
    { time[$1,$2,$3] = $4; if ($5 + 0 > error[$1,$2]) error[$1,$2] = $5 + 0; if ($3 > rounds) rounds = $3 }
    END {
      m = split(peers, peer, " ")
      for (k = split("10 20 50 100 200 500", n, " "); k > 0; --k) for (p = 1; p <= m; ++p) {
        for (r = 1; r <= rounds; ++r) { t[r] = time[peer[p],n[k],r]; q[r] = t[r]/time["scree",n[k],r] }
        ratio = middle(q, rounds); half = middle(t, rounds)
        print n[k], p, peer[p], half, t[1], t[rounds], error[peer[p],n[k]], ratio
      }
    }' "$rows" | sort -g -k1,1 -k2,2 | cut -d' ' -f1,3-
}

table() {
  local peer head='| steps per contact |' line='|---|'
  for peer in "${peers[@]}"; do head+=" error, $(name_of $peer) |" line+='---|'; done
  for peer in "${peers[@]}"; do head+=" time, ms, $(name_of $peer) |" line+='---|'; done
  printf '%s\n%s\n' "$head" "$line"
  awk '
    function flush() { if (n != "") print "| " n errors times " |" }
    $1 != n { flush(); n = $1; errors = ""; times = "" }
    { errors = errors sprintf(" | %.4e", $6)
      times = times sprintf(" | %.3g (%.3g to %.3g)%s", 1e3*$3, 1e3*$4, 1e3*$5, $2 == "scree" ? "" : sprintf(", **%.3g**", $7)) }
    END { flush() }' "$work/condensed"
}

picture() {  # FILE
  local peer plot='' steps='' k=0
  for peer in "${peers[@]}"; do
    k=$((k + 1))
    awk -v p="$peer" '$2==p' "$work/condensed" > "$work/$peer.dat"
    plot+="${plot:+, }'$work/$peer.dat' using 3:6:4:5 with xerrorbars lc $k pt 7 ps 0.6 notitle, '' using 3:6 with lines lc $k title '$(name_of $peer)'"
    # Rings of growing size: the codes lie on one another.
    steps+="${steps:+, }'$work/$peer.dat' using 1:6 with points lc $k pt 6 ps $k*0.6 title '$(name_of $peer)'"
  done
  gnuplot << PLOT
set terminal svg size 960,440 dynamic background 'white' font 'sans,12'
set output '$1'
set multiplot layout 1,2
set logscale xy
set format y '10^{%T}'
set grid
set ylabel 'largest |v_{out}/v_{in} - 1|'
set key bottom left
set xlabel 'time of the run, s'
set format x '10^{%T}'
plot $plot
set xlabel 'steps per contact'
set format x '%g'
set xrange [7:700]
plot $steps, 6.56e-6*(100/x)**2.5 with lines dt 2 lc rgb 'gray' title 'slope -5/2'
unset multiplot
PLOT
}

versions() {
  local package version text="scree $("${SCREE:-../../build/bin/scree}" --version | awk '{print $NF}')"
  for package in lammps liggghts yade; do
    version=$(dpkg-query -W -f '${Version}' $package 2> /dev/null) && text+=", $package $version"
  done
  echo "$text (the others as Debian ships them); $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)."
}

impact() {
  local page=${PAGE:-../../docs/peers.md} picture=${PICTURE:-pictures/impact_peers.svg} rows=$work/rows peers=() peer
  local balls=${BALLS:-8000} rounds=${ROUNDS:-7}
  for peer in scree lammps liggghts yade; do
    if [ $peer = scree ] || command -v "$(program_of $peer)" > /dev/null; then
      peers+=($peer)
    else
      echo "peers: $(name_of $peer) is not installed and is left out" >&2
    fi
  done
  measure_impacts
  condense > "$work/condensed"
  mkdir -p "$(dirname "$(dirname "$page")/$picture")"
  picture "$(dirname "$page")/$picture"
  {
    cat << TEXT
# Impacts beside other codes

Written by \`PARTS=impact ./dev verify peers\`. Scene S5 of [tests/peers/scenes.md](../tests/peers/scenes.md): spheres of 4 mm that meet in pairs, head-on at 1 m/s, with elastic Hertz contacts
without friction; $((balls / 2)) pairs far apart, over four start phases of the step, 2 n + 10 steps at n steps per contact. The error is the largest |v_out/v_in - 1| over all balls.

The time is wall time of the loop over the steps as each code tells it, on one core, in turns: the median of $rounds rounds, least and most in brackets, and in bold how many times that of
scree, as the median of the rounds. Set-up is left out; so is the first search for neighbours by LAMMPS and LIGGGHTS, and YADE's first step, which sorts all balls. For scree it is counted.

$(versions)

TEXT
    table
    printf '\n![Error against time of the run and against steps per contact](%s)\n' "$picture"
  } > "$work/page"
  mv "$work/page" "$page"
  cat "$page"
}

for part in $parts; do "$part"; done
