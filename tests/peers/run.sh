#!/bin/bash
# The same scenes in scree and in other codes, one after the other on one core. scenes.md says what each scene is.
#   run.sh install                      other codes from Debian's packages (as root)
#   run.sh prep [chute|settle|ucs|drum|big]...   starting states, by default all four; big: the large chute and settle too
#   run.sh stats                        contacts per ball of every state made so far
#   run.sh one PEER SCENE N [W] [S]     W warm-up steps, then S timed ones
#   run.sh all [big]
# one prints: peer scene N steps loop_seconds ballsteps_per_s rss_kb
#   loop_seconds is the CPU time of the solver in the timed loop, set-up excluded, so a busy machine disturbs it little;
#   with RANKS > 1 it is the wall time.
#   peers: scree (chute) lammps liggghts yade esys      scenes: chute settle ucs drum
# CORE (0): the CPU to pin to, as taskset spells it.  R (1): repeats, the best is printed.  RANKS (1): ranks or threads.
# PEERS_CACHE (scree-peers in the user's cache folder): where the states lie.  SCREE: the program, by default build/bin/scree.
set -u
here=$(cd "$(dirname "$0")" && pwd)
cache=${PEERS_CACHE:-${XDG_CACHE_HOME:-$HOME/.cache}/scree-peers}
core=${CORE:-0} py=${PY:-/usr/bin/python3} ranks=${RANKS:-1} repeats=${R:-1}
scree=${SCREE:-$here/../../build/bin/scree}
export D=$cache OMP_NUM_THREADS=$ranks OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
mkdir -p "$cache"
cd "$here" || exit 1
pin=(taskset -c "$core")
lammps=(lmp -nocite -log none)
mpi=(mpirun --bind-to none --mca mpi_yield_when_idle 1)
timed=(/usr/bin/time -f 'TIME %U %S %e %M')

# settle_state SCENE N DT STEPS FRICTION: loose lattice, then a settling run in LAMMPS.
settle_state() {
  [ -f "$cache/$1_$2.csv" ] && return
  local deck=settle.in
  [ "$1" = chute ] && deck=chute.in
  "$py" gen.py init "$1" "$2" "$cache" || exit 1
  "${pin[@]}" "${lammps[@]}" -in lammps/$deck -var N "$2" -var D "$cache" -var SC "$1" -var PREP 1 \
    -var DT "$3" -var T "$4" -var MU "$5" > "$cache/prep_$1_$2.log" 2>&1 ||
    { echo "run.sh: LAMMPS failed, see $cache/prep_$1_$2.log" >&2; exit 1; }
  "$py" gen.py pack "$1" "$2" "$cache" || exit 1
  rm -f "$cache/$1_$2.dump"
}

tile_chute() {  # N TIMES_X TIMES_Y
  [ -f "$cache/chute_$1.csv" ] || "$py" gen.py tile chute 8000 "$1" "$2" "$3" "$cache"
}

prep() {
  [ $# -eq 0 ] && set -- chute settle ucs drum
  local scene
  for scene in "$@"; do
    case $scene in
      chute) settle_state chute 8000 1e-3 12000 0.5; tile_chute 32000 2 2 ;;
      settle) settle_state settle 10000 4e-5 4500 0.5 ;;
      ucs)
        settle_state ucs 10000 4e-5 9000 0.0
        [ -f "$cache/ucs_10000_bonds.csv" ] || "$py" gen.py bonds ucs 10000 "$cache" ;;
      drum)
        [ -f "$cache/drum.stl" ] || "$py" gen.py mesh "$cache"
        settle_state drum 20000 2.5e-5 6000 0.5 ;;
      big) prep chute; tile_chute 256000 8 4; settle_state settle 100000 4e-5 4500 0.5 ;;
      *) echo "run.sh: no scene '$scene' (chute, settle, ucs, drum, big)" >&2; exit 2 ;;
    esac
  done
}

# Each peer_* prints "loop_cpu_seconds rss_kb loop_wall_seconds"; nothing when it failed.
peer_lammps() {
  local deck=$scene.in dt=4e-5 launch=()
  [ "$scene" = drum ] && deck=settle.in dt=2.5e-5
  [ "$ranks" -gt 1 ] && launch=("${mpi[@]}" -x OMP_NUM_THREADS=1 -np "$ranks")
  "${timed[@]}" "${pin[@]}" "${launch[@]}" "${lammps[@]}" -in lammps/"$deck" -var N "$n" -var D "$cache" \
    -var SC "$scene" -var DT $dt -var PREP 0 -var W "$warm" -var S "$steps" > "$log" 2>&1
  awk '/^Loop time/{t=$4} /% CPU use/{c=$1+0} /^TIME/{m=$5} END{if(t) print t*(c<100?c/100:1),m,t}' "$log"
}

# Its own loop time is wall time only: the CPU time of the warm-up run is taken off that of the whole.
peer_liggghts() {
  local launch=() s
  [ "$ranks" -gt 1 ] && launch=("${mpi[@]}" -x OMP_NUM_THREADS=1 -np "$ranks")
  for s in 0 "$steps"; do
    "${timed[@]}" "${pin[@]}" "${launch[@]}" liggghts -nocite -log none -in liggghts/"$scene".in -var N "$n" \
      -var D "$cache" -var W "$warm" -var S "$s" > "$log.$s" 2>&1
  done
  awk -v n="$ranks" 'FNR==NR{if(/^TIME/)a=$2+$3;next} /^Loop time/{t=$4} /^TIME/{b=$2+$3;m=$5}
                     END{if(t) print (b-a)/n,m,t}' "$log.0" "$log.$steps"
}

peer_yade() {
  SCENE=$scene N=$n W=$warm S=$steps timeout 150 "${pin[@]}" yade -j"$ranks" -n -x yade/scene.py > "$log" 2>&1
  sed -n 's/^RESULT loop_cpu=\([0-9.]*\) loop_wall=\([0-9.]*\) rss_kb=\([0-9]*\).*/\1 \3 \2/p' "$log" |
    awk -v n="$ranks" '{print $1/n,$2,$3}'
}

peer_esys() {
  SCENE=$scene N=$n W=$warm S=$steps NW=$ranks timeout 150 "${pin[@]}" "${mpi[@]}" -np $((ranks + 1)) \
    esysparticle esys/scene.py > "$log" 2>&1
  sed -n 's/^RESULT loop_cpu=\([0-9.]*\) master_cpu=[0-9.]* loop_wall=\([0-9.]*\) rss_kb=\([0-9]*\).*/\1 \3 \2/p' \
    "$log" | awk -v n="$ranks" '{print $1/n,$2,$3}'
}

# The rate in summary.json is that of the cycles, set-up and output excluded; as for LAMMPS it is scaled by the share of
# the CPU that the process had. A scene reads files of its own folder only, so the state is copied beside it.
peer_scree() {
  local folder length width
  case $n in 8000) length=20 width=10 ;; 32000) length=40 width=20 ;; 256000) length=160 width=40 ;; esac
  folder=$(mktemp -d)
  cp scree/"$scene".yaml "$folder" && cp "$cache/${scene}_$n.csv" "$folder/$scene.csv" || return
  "${timed[@]}" "${pin[@]}" "$scree" run "$folder/$scene.yaml" --quiet -j "$ranks" -n $((warm + steps)) \
    -o "$folder/run.out" --set vars.length=$length --set vars.width=$width > "$log" 2>&1
  awk -v s="$steps" -v n="$n" 'FNR==NR{if($1=="\"ball_steps_per_second\":")r=$2+0;next}
    /^TIME/{c=($2+$3)/$4; m=$5} END{if(r){t=s*n/r; print t*(c<1?c:1),m,t}}' "$folder/run.out/summary.json" "$log"
  cp "$folder/run.out/summary.json" "$log.json" 2> /dev/null
  rm -rf "$folder"
}

one() {
  local peer=$1 scene=$2 n=$3 warm=${4:-100} steps=${5:-500} best='' result k
  local log="$cache/last_${peer}_${scene}_$n.log"
  for ((k = 0; k < repeats; k++)); do
    result=$(peer_"$peer")
    [ -z "$result" ] && { echo "$peer $scene $n FAILED, see $log" >&2; return 1; }
    best=$(printf '%s\n%s\n' "$best" "$result" | grep . | sort -g | head -1)
  done
  set -- $best
  local t=$1
  [ "$ranks" -gt 1 ] && t=$3
  echo "$peer $scene $n $steps $t $(awk -v n="$n" -v s="$steps" -v t="$t" 'BEGIN{printf "%.0f", n*s/(t+1e-9)}') $2"
}

all() {
  local peer scene n s
  for peer in scree lammps liggghts yade esys; do
    for scene in chute settle ucs drum; do
      case $peer-$scene in
        scree-settle | scree-ucs | scree-drum | lammps-ucs | liggghts-ucs | esys-drum) continue ;;
      esac
      n=10000 s=500
      [ $scene = chute ] && n=32000
      [ $scene = drum ] && n=20000
      case $peer in yade) s=100 ;; esys) s=150 ;; esac
      one $peer $scene $n 50 $s
    done
    [ "${1:-}" = big ] || continue
    one $peer chute 256000 10 40
    [ $peer = scree ] || one $peer settle 100000 20 50
  done
}

case ${1:-} in
  install)
    DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
      time lammps liggghts yade esys-particle python3-numpy python3-scipy ;;
  prep | one | all) "$@" ;;
  stats)
    for f in "$cache"/*_*.csv; do
      b=$(basename "$f" .csv)
      case $b in *bonds) ;; *) "$py" gen.py stats "${b%_*}" "${b#*_}" "$cache" ;; esac
    done ;;
  *) sed -n 2,15p "$0" ;;
esac
