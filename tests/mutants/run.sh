#!/usr/bin/env bash
# Which one-line errors in kernels and shared headers do the tests notice?
#
#   tests/mutants/run.sh [options] [list ...]     all lists where none is named
#
#   -n NUMBER  this mutant alone, or these (3-9); of one list
#   -c         only check that every mutant's text is found exactly once
#   -b FOLDER  where to build; ./build-mutants where not named
#   -l FILE    the mutants of this list instead (tests/mutants/sample.py makes some by rule)
#
# A module's errors are in <module>.txt beside this file: blocks of lines, parted by empty ones.
#
#   file: kernels/image/gather.cl     what is changed, from the root of the project
#   old: red * (1.0f / CLGI_PI)       text of one line, found exactly once in the file
#   new: red                          what stands there instead; may be empty
#   test: shading_test Gather.*       who should notice: test program and filter of GoogleTest, or
#                                     the program alone; one line for each
#
# Works on a copy of the sources. Only the library is built again for each mutant: it is shared,
# and kernels are text in it. CLGI_MUTANTS_PREFIX goes before every build and test command ("nice").
# Exit code 0: all caught; 1: some survived or do not build; 2: the lists or the tests are wrong.
# SPDX-License-Identifier: MIT
set -euo pipefail
# shellcheck source-path=SCRIPTDIR source=../../cmake/setup.sh
source "$(dirname -- "${BASH_SOURCE[0]}")/../../cmake/setup.sh"

folder=$clgi_root/build-mutants
only=""
check=0
list_file=""
while getopts "n:cb:l:" option; do
    case $option in
        n) only=$OPTARG ;;
        c) check=1 ;;
        b) folder=$OPTARG ;;
        l) list_file=$OPTARG ;;
        *) exit 2 ;;
    esac
done
shift $((OPTIND - 1))
lists=("$@")
if [[ -n $list_file ]]; then
    lists=(sample)
elif ((${#lists[@]} == 0)); then
    for list in "$clgi_root"/tests/mutants/*.txt; do lists+=("$(basename "$list" .txt)"); done
fi
mkdir -p "$folder"
folder=$(cd -- "$folder" && pwd)
copy=$folder/source
build=$folder/build
read -ra prefix <<<"${CLGI_MUTANTS_PREFIX:-}"

fail() {
    echo "mutants: error: $*" >&2
    exit 2
}

# ---- the lists ---------------------------------------------------------------------------------
names=() files=() olds=() news=() tests=()  # tests: a line each

# read_list LIST
read_list() {
    local list=${list_file:-$clgi_root/tests/mutants/$1.txt} line number=0 open=0
    [[ -f $list ]] || fail "no list of mutants $list"
    while IFS= read -r line || [[ -n $line ]]; do
        case $line in
            '#'*) continue ;;
            '') open=0 && continue ;;
        esac
        if ((!open)); then
            open=1
            number=$((number + 1))
            names+=("$1 $number") files+=("") olds+=("") news+=("") tests+=("")
        fi
        local value=${line#*:}
        value=${value# }
        case $line in
            file:*) files[-1]=$value ;;
            old:*) olds[-1]=$value ;;
            new:*) news[-1]=$value ;;
            test:*) tests[-1]+=$value$'\n' ;;
            *) fail "$1 $number: a line that is not file, old, new or test: $line" ;;
        esac
    done <"$list"
}

# check_mutant INDEX: its text stands exactly once in the working tree.
check_mutant() {
    local name=${names[$1]} file=$clgi_root/${files[$1]} old=${olds[$1]}
    [[ -n ${files[$1]} && -n $old && -n ${tests[$1]} ]] || fail "$name: needs file, old, new, test"
    [[ -f $file ]] || fail "$name: no file ${files[$1]}"
    [[ $old != "${news[$1]}" ]] || fail "$name: old and new are the same"
    local text rest
    text=$(<"$file")
    rest=${text//"$old"/}
    local found=$(((${#text} - ${#rest}) / ${#old}))
    ((found == 1)) || fail "$name: found $found times in ${files[$1]}, not once: $old"
}

for name in "${lists[@]}"; do read_list "$name"; done
chosen=("${!names[@]}")
if [[ -n $only ]]; then
    ((${#lists[@]} == 1)) || fail "-n takes one list"
    first=${only%-*} last=${only#*-}
    ((first >= 1 && first <= last && last <= ${#names[@]})) ||
        fail "no mutants $only: ${lists[0]} has ${#names[@]}"
    mapfile -t chosen < <(seq $((first - 1)) $((last - 1)))
fi
for i in "${chosen[@]}"; do check_mutant "$i"; done
((!check)) || { echo "${#chosen[@]} mutants, each found once" && exit; }

# ---- the copy ----------------------------------------------------------------------------------
parts=(CMakeLists.txt cmake docs host include kernels samples tests README.md LICENSE)

# Brings the copy up to date, touching what differs alone.
synchronise() {
    local file
    mkdir -p "$copy"
    (cd "$clgi_root" && find "${parts[@]}" -type f -print0) |
        while IFS= read -r -d '' file; do
            cmp -s "$clgi_root/$file" "$copy/$file" && continue
            mkdir -p "$(dirname "$copy/$file")"
            cp "$clgi_root/$file" "$copy/$file"
        done
    (cd "$copy" && find . -type f -print0) |
        while IFS= read -r -d '' file; do
            [[ -f $clgi_root/$file ]] || rm "$copy/$file"
        done
}

run() { "${prefix[@]}" "$@"; }

# build_target TARGET: its output is in $folder/build.log
build_target() {
    run cmake --build "$build" --parallel "$(nproc)" --target "$1" >"$folder/build.log" 2>&1 9>&-
}

# run_test "PROGRAM [FILTER]": its output is in $folder/test.log
run_test() {
    local program=${1%% *} filter='*'
    [[ $1 == *' '* ]] && filter=${1#* }
    run timeout 600 "$build/tests/$program" --gtest_fail_fast --gtest_brief=1 \
        "--gtest_filter=$filter" >"$folder/test.log" 2>&1 </dev/null
}

exec 9>"$folder/lock"
flock -n 9 || fail "another run works in $folder; -b takes another folder"
synchronise
generator=(-G Ninja)
[[ -f $build/CMakeCache.txt ]] && generator=()
cmake -S "$copy" -B "$build" "${generator[@]}" -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=ON \
    -DCLGI_TESTS=ON -DCLGI_SCENES_DIR="$clgi_root/../shared/scenes" >"$folder/build.log" 2>&1 ||
    fail "cmake: see $folder/build.log"

# ---- without a mutation: everything is green ----------------------------------------------------
mapfile -t needed < <(for i in "${chosen[@]}"; do printf %s "${tests[$i]}"; done | sort -u)
build_target clgi || fail "the library does not build: see $folder/build.log"
for program in $(printf '%s\n' "${needed[@]}" | cut -d' ' -f1 | sort -u); do
    build_target "$program" || fail "$program does not build: see $folder/build.log"
done
for test in "${needed[@]}"; do
    run_test "$test" || fail "fails without any mutation: $test; see $folder/test.log"
    grep -q 'Running 0 tests\|^\[==========\] 0 tests' "$folder/test.log" &&
        fail "a filter that no test passes: $test"
done
echo "${#needed[@]} tests are green without a mutation"

# ---- mutants -----------------------------------------------------------------------------------
restore=()  # file and text of the mutant at work
undo() {
    ((${#restore[@]} == 0)) || printf %s "${restore[1]}" >"${restore[0]}"
    restore=()
}
trap undo EXIT

caught=0 survived=0 invalid=0

# try_mutant INDEX: prints its line.
try_mutant() {
    local file=$copy/${files[$1]} text test by=""
    text=$(cat "$file" && printf x)
    text=${text%x}
    restore=("$file" "$text")
    printf %s "${text/"${olds[$1]}"/"${news[$1]}"}" >"$file"
    local label
    label=$(printf '%-11s %s: %s -> %s' "${names[$1]}" "${files[$1]##*/}" "${olds[$1]}" "${news[$1]}")
    if ! build_target clgi; then
        echo "$label: DOES NOT BUILD"
        invalid=$((invalid + 1))
        undo
        return
    fi
    while IFS= read -r test; do
        run_test "$test" && continue
        by=$(sed -n 's/^\[  FAILED  \] \([^ ,]*\).*/\1/p' "$folder/test.log" | head -n 1)
        [[ -n $by ]] || by="its end"  # killed, or out of time
        by="${test%% *} $by"
        break
    done <<<"${tests[$1]%$'\n'}"
    undo
    if [[ -n $by ]] && grep -q "does not build on" "$folder/test.log"; then
        echo "$label: DOES NOT BUILD on the device"
        invalid=$((invalid + 1))
    elif [[ -n $by ]]; then
        echo "$label: caught by $by"
        caught=$((caught + 1))
    else
        echo "$label: SURVIVED"
        survived=$((survived + 1))
    fi
}

for i in "${chosen[@]}"; do try_mutant "$i"; done
build_target clgi || true  # the library as it was
echo "${#chosen[@]} mutants, $caught caught, $survived survived, $invalid do not build"
((survived == 0 && invalid == 0))
