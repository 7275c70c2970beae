#!/usr/bin/env bash
# faults.sh CASE: what goes wrong ends with the right exit code, a message that says where, and nothing half-written.
. "$(dirname "$0")/common.sh"

here=$(cd "$(dirname "$0")" && pwd)
out=$WORK/results
run() { local code=$1; shift; expect "$code" "$TAUTLINE" run "$@" -o "$out" --quiet --no-pictures; }

case $1 in
  bad_deck)
    run 2 "$SOURCE/tests/decks/bad/many_errors.yaml"
    says "$WORK/err" 'many_errors\.yaml:[0-9]+:[0-9]+: error: '
    [ "$(grep -c ': error: ' "$WORK/err")" -gt 2 ] || fail "not all errors were told at once"
    nothing_in "$out"
    ;;
  missing_deck)
    run 2 "$WORK/nowhere.yaml"
    says "$WORK/err" 'nowhere\.yaml'
    nothing_in "$out"
    ;;
  deck_is_a_directory)
    run 2 "$WORK"
    nothing_in "$out"
    ;;
  bad_override)
    run 2 "$SOURCE/inputs/frame.yaml" --set parameters.no_such_thing=1
    says "$WORK/err" 'no_such_thing'
    nothing_in "$out"
    ;;
  bad_command_line)
    expect 2 "$TAUTLINE" run
    expect 2 "$TAUTLINE" walk "$SOURCE/inputs/frame.yaml"
    expect 2 "$TAUTLINE" run "$SOURCE/inputs/frame.yaml" --sideways
    ;;
  missing_mesh)
    run 2 "$SOURCE/tests/decks/bad/missing_mesh_file.yaml"
    nothing_in "$out"
    ;;
  mesh_without_group)
    sed "s|\.\./meshes|$SOURCE/meshes|; s|edge: |border: |" "$SOURCE/inputs/membrane_gmsh.yaml" >"$WORK/deck.yaml"
    expect 3 "$TAUTLINE" check "$WORK/deck.yaml"
    run 3 "$WORK/deck.yaml"
    says "$WORK/err" 'border|edge'
    nothing_in "$out"
    ;;
  coincident_nodes)
    run 3 "$here/decks/coincident_nodes.yaml"
    says "$WORK/err" 'strut'
    nothing_in "$out"
    ;;
  mechanism)
    expect 3 "$TAUTLINE" check "$here/decks/mechanism.yaml"
    says "$WORK/err" 'mechanism|can move|singular'
    run 3 "$here/decks/mechanism.yaml"
    says "$WORK/err" 'mechanism|can move|singular'
    ;;
  unsupported)   # vibrates, but finds no equilibrium unless told that it floats
    expect 3 "$TAUTLINE" check "$here/decks/unsupported.yaml"
    says "$WORK/err" 'nothing is supported.*support: free'
    run 3 "$here/decks/unsupported.yaml"
    says "$WORK/err" 'nothing is supported.*support: free'
    ;;
  loose_part)
    expect 3 "$TAUTLINE" check "$here/decks/loose_part.yaml"
    says "$WORK/err" 'mechanism|can move|singular|loose|connected'
    run 3 "$here/decks/loose_part.yaml"
    ;;
  buckling_without_loads)   # nothing grows, so that nothing can buckle
    sed -n '1,/^steps:/p' "$SOURCE/inputs/strut.yaml" >"$WORK/deck.yaml"
    echo '  - {kind: buckling, loads: [], modes: 1}' >>"$WORK/deck.yaml"
    run 3 "$WORK/deck.yaml"
    says "$WORK/err" 'stress nothing'
    ;;
  no_mechanism)   # what the loads tighten is no mechanism to `check` either
    for deck in slack_catenary swing; do
      expect 0 "$TAUTLINE" check "$here/decks/$deck.yaml"
      says "$WORK/out" 'note: step "equilibrium": as drawn, the structure can move without resistance'
      run 0 "$here/decks/$deck.yaml"
    done
    ;;
  check_is_run_without_the_solve)   # what a step refuses before it solves, check refuses as well, in the same words
    sed 's|^steps:.*|steps:\n  - {kind: modal, modes: 50}|; /^  - kind: equilibrium/d' "$here/decks/swing.yaml" >"$WORK/modes.yaml"
    sed 's|^steps:.*|steps:\n  - {kind: buckling}|; /^  - kind: equilibrium/d' "$here/decks/slack_catenary.yaml" >"$WORK/cables.yaml"
    sed 's|force: .*}|displacement: [0, 0, -0.1]}|' "$here/decks/swing.yaml" >"$WORK/motion.yaml"
    for case in 'modes|Ask for at most' 'cables|carry no compression' 'motion|node "lamp" of "arm"'; do
      expect 3 "$TAUTLINE" check "$WORK/${case%%|*}.yaml"
      says "$WORK/err" "${case#*|}"
      run 3 "$WORK/${case%%|*}.yaml"
      says "$WORK/err" "${case#*|}"
    done
    ;;
  lost_prestress)
    run 4 "$here/decks/lost_prestress.yaml"
    says "$WORK/out" '"high" lost its prestress: [0-9.]+ of [0-9]+ N left'
    says "$WORK/out" '"high_ring" lost its prestress'
    says "$WORK/out" 'Remedy: .*more prestress'
    says "$out/results.json" '"findings"'
    ! grep -q 'supports leave' "$WORK/out" || fail "the supports are blamed for the load"
    ;;
  doubts)
    expect 0 "$TAUTLINE" check "$here/decks/doubts.yaml"
    for what in 'the diameter is 120 m' 'in mm/s\^2' 'below absolute zero' 'has the same nodes'; do
      says "$WORK/out" "warning: .*$what"
    done
    run 0 "$here/decks/doubts.yaml"
    for code in section_size acceleration temperature duplicate_elements; do
      says "$out/results.json" "\"code\": \"$code\""
    done
    says "$WORK/out" 'Warning: .*absolute|Warning:'
    says "$out/report.html" 'below absolute zero'
    ;;
  pressed_ties)   # the rim is so low that the net would hang above it: ties would have to push
    run 3 "$SOURCE/inputs/dish_4m.yaml" --set reflector.rim_height=0.25
    says "$WORK/err" 'tie'
    ;;
  tuning_by_rule)   # of cords that do not begin at the front net
    sed 's|- kind: tuning|- {kind: tuning, ties: end_cords}|' "$SOURCE/inputs/perimeter_truss_48m.yaml" >"$WORK/deck.yaml"
    run 3 "$WORK/deck.yaml" --set parameters.subdivisions=1
    says "$WORK/err" '"end_cords".*method: sensitivity'
    ;;
  not_converged)
    run 4 "$here/decks/not_converged.yaml"
    valid "$out" not_converged
    says "$out/results.json" '"name": "prestress"'
    says "$out/results.json" '"reason": "step .*push.*"'
    has "$WORK/out" "$out"/{nodes.csv,cables.csv,fields.pvd,report.html}     # the last good state
    says "$out/nodes.csv" '^[0-9]+,'
    grep -Eqi 'nan|inf' "$out/nodes.csv" && fail "the last state is not a number"
    ;;
  form_finding_not_converged)
    run 4 "$SOURCE/inputs/dish_4m.yaml" --set steps.form_finding.max_iterations=1
    valid "$out" not_converged
    ;;
  rods_diverging)   # with equal stiffness the published iteration does not contract; Newton's method does not mind
    sed 's|bending_stiffness: .*|bending_stiffness: 1000|' "$SOURCE/inputs/rod_umbrella_m4_l10.yaml" >"$WORK/deck.yaml"
    run 4 "$WORK/deck.yaml" --set steps.as_published.solver=successive
    valid "$out" not_converged
    says "$out/results.json" '"reason": "step .*diverges'
    run 0 "$WORK/deck.yaml"
    run 3 "$WORK/deck.yaml" --set reflector.root_radius=0
    says "$WORK/err" 'root_radius'
    ;;
  unwritable)
    touch "$WORK/results"                           # a file where the directory should be
    run 5 "$SOURCE/inputs/frame.yaml"
    says "$WORK/err" "$WORK/results"
    out=$WORK/results/below
    run 5 "$SOURCE/inputs/frame.yaml"
    out=/proc/tautline_results                      # nobody can make a directory there, not even root
    run 5 "$SOURCE/inputs/frame.yaml"
    says "$WORK/err" "/proc/tautline_results"
    ;;
  full_disk)   # behind stdout, and behind the results
    expect 5 bash -c '"$0" run "$1" -o "$2" --no-pictures >/dev/full' "$TAUTLINE" "$SOURCE/inputs/frame.yaml" "$out"
    says "$WORK/err" 'standard output'
    expect 5 bash -c '"$0" explain >/dev/full' "$TAUTLINE"
    ;;
  not_enough_memory)   # is told as that
    expect 5 bash -c 'ulimit -v 2500000; "$0" check "$1" --set reflector.rings=1000' "$TAUTLINE" "$SOURCE/inputs/perimeter_truss_12m.yaml"
    says "$WORK/err" 'not enough memory'
    ;;
  old_results)   # do not stay beside new ones
    run 0 "$SOURCE/inputs/dish_4m.yaml"
    has "$out"/membranes.csv
    echo mine >"$out/mine.csv"
    run 0 "$SOURCE/inputs/frame.yaml"
    [ ! -e "$out/membranes.csv" ] || fail "membranes.csv of another run stands beside the new results"
    has "$out"/{beams.csv,mine.csv}
    ;;
  two_runs)   # in one directory
    "$TAUTLINE" run "$SOURCE/inputs/perimeter_truss_12m.yaml" -o "$out" --quiet --no-pictures >"$WORK/first" 2>&1 &
    for _ in $(seq 300); do [ -s "$out/results.json" ] && break; sleep 0.1; done
    run 5 "$SOURCE/inputs/frame.yaml"
    says "$WORK/err" 'another run \(process [0-9]+ on '
    for command in "report $out" "study $SOURCE/inputs/dish_4m.yaml -o $out" "study $SOURCE/inputs/dish_4m.yaml --over subdivisions=2 -o $out"; do
      expect 5 "$TAUTLINE" $command
      says "$WORK/err" 'another run \(process [0-9]+ on '
    done
    kill -9 %1
    wait || true
    run 0 "$SOURCE/inputs/frame.yaml"   # the lock of a process that is no more
    ;;
  step_names)   # stay inside the output directory, and one file name each
    sed "s|name: exact_b|name: ../../escaped|" "$SOURCE/inputs/rod_umbrella_m4_l5.yaml" >"$WORK/deck.yaml"
    out=$WORK/a/b/results
    run 0 "$WORK/deck.yaml"
    [ -z "$(find "$WORK" -name '*escaped*' -not -path "$out/*")" ] || fail "files outside the output directory"
    [ -n "$(find "$out" -name '*escaped*.csv')" ] || fail "the tables of the step are missing"
    out=$WORK/results
    run 0 "$here/decks/two_steps.yaml"
    has "$out"/fields/{a_b,a_b_2}.vtu
    ;;
  petsc_options)   # of files in the current directory and of the environment are taken only when asked for
    cd "$WORK"
    echo '-options_left' >.petscrc
    PETSC_OPTIONS=-help expect 0 "$TAUTLINE" run "$SOURCE/inputs/frame.yaml" -o "$out" --quiet --no-pictures
    grep -q 'Option Table' "$WORK/out" "$WORK/err" && fail "options were taken"
    TAUTLINE_PETSC_OPTIONS=1 expect 0 "$TAUTLINE" run "$SOURCE/inputs/frame.yaml" -o "$out" --quiet --no-pictures
    says "$WORK/out" 'Option Table'
    says "$out/results.json" '"petsc_options"'
    ;;
  unwritable_on_two_ranks)
    touch "$WORK/results"
    expect 5 timeout 60 "${@:2}" "$TAUTLINE" run "$SOURCE/inputs/frame.yaml" -o "$WORK/results" --quiet --no-pictures
    ;;
  bad_deck_on_two_ranks)
    expect 2 timeout 60 "${@:2}" "$TAUTLINE" run "$SOURCE/tests/decks/bad/unknown_material.yaml" -o "$out" --quiet
    [ "$(grep -c 'unknown_material\.yaml:[0-9]' "$WORK/err")" -eq 1 ] || fail "the error was not told exactly once"
    nothing_in "$out"
    ;;
  mechanism_on_two_ranks)
    expect 3 timeout 60 "${@:2}" "$TAUTLINE" run "$here/decks/mechanism.yaml" -o "$out" --quiet --no-pictures
    ;;
  *) fail "no such case: $1" ;;
esac
done_testing
