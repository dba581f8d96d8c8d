#!/usr/bin/env bash
# the chute of tests/peers in scree and in LAMMPS, in turns on one core: ball-steps per second and their ratio
set -euo pipefail
cd "$(dirname "$0")/../peers"

n=${N:-32000} warm=${WARM:-100} steps=${STEPS:-800} pairs=${PAIRS:-5}
./run.sh prep chute
rows=$(mktemp)
for ((k = 1; k <= pairs; k++)); do
  for peer in scree lammps; do
    ./run.sh one $peer chute "$n" "$warm" "$steps" | tee -a "$rows"
  done
done
median() { sort -g | awk '{v[NR]=$1} END{print NR%2 ? v[(NR+1)/2] : (v[NR/2]+v[NR/2+1])/2}'; }
rate() { awk -v p="$1" '$1==p{print $6}' "$rows"; }
printf '\nchute, %s balls, %s steps, median of %s pairs\n' "$n" "$steps" "$pairs"
for peer in scree lammps; do printf '%-8s %12.0f ball-steps/s\n' $peer "$(rate $peer | median)"; done
printf '%-8s %12.3f scree over lammps, median of the pairs\n' ratio \
  "$(paste <(rate scree) <(rate lammps) | awk '{print $1/$2}' | median)"
rm -f "$rows"
