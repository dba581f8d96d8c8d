#!/usr/bin/env bash
# kernel_names.sh PROGRAM SOURCE: no symbol of the program bears the name of a law, wall, generator, process or writer; what
# the sources hold as text is looked at by tests/unit/house_rules_test.cpp.
set -euo pipefail
program=$1 source=$2

# Words of the language of the kernel that a component happens to be called: a file below the output folder, the random
# numbers of generators, and the share of local damping that a process of any name may tell the step.
allowed=" file File Random local_damping "

names() { (cd "$source" && ls -d contact_models/*/ plugins/*/*/) | xargs -n1 basename; }
pascal() { sed -E 's/(^|_)([a-z])/\U\2/g'; }
identifiers() { nm -C "$1" | grep -oE '\bscree::[A-Za-z_0-9:~]+' | tr ':' '\n' | sort -u; }

[ "$(names | wc -l)" -ge 10 ]
forbidden=$({ names; names | pascal; } | while read -r name; do [[ $allowed == *" $name "* ]] || echo "$name"; done)
bad=$(identifiers "$program" | grep -xF "$forbidden" || true)
[ -z "$bad" ] || { echo "the program has symbols with names of components: $bad"; exit 1; }

# The check sees a name where there is one: every law, wall ... has its own in its library.
library=$(dirname "$program")/../$3/contact_model/linear.so
[ "$(nm -C "$library" | grep -c 'Linear')" -gt 0 ] || { echo "no symbol 'Linear' in $library: this test is blind"; exit 1; }
[ "$(identifiers "$program" | grep -cx Engine)" = 1 ] || { echo "no symbol 'Engine' in $program: this test is blind"; exit 1; }
