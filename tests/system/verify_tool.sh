#!/usr/bin/env bash
# tautline_verify itself, on made-up results: it passes what is right, and fails what is wrong, missing or unexplained.
. "$(dirname "$0")/common.sh"

case_dir=$WORK/source/verification/made_up
mkdir -p "$case_dir" "$WORK/runs/made_up/a"
printf '# Made up\n' >"$case_dir/README.md"
cat >"$WORK/runs/made_up/a/results.json" <<'JSON'
{"steps": [{"name": "one", "rms": 2.0}, {"name": "two", "list": [1, 2, 4], "passes": [{"rms": 5}, {"rms": 7}]}]}
JSON
printf 'id,group,x,y\n1,net,0,0\n2,net,3,4\n3,rim,6,8\n' >"$WORK/runs/made_up/a/nodes.csv"

# examine CODE VALUE REST: one quantity with this expression, and this exit code.
examine() {
  printf 'runs:\n  - {name: a, deck: none.yaml}\nquantities:\n  - {name: q, value: "%s", %s}\n' "$2" "$3" >"$case_dir/expected.yaml"
  expect "$1" "$VERIFY" made_up --program none --source "$WORK/source" --work "$WORK/runs" --reuse
}

examine 0 '{a:/steps/one/rms}' 'reference: 2, relative: 1e-9, origin: analytic'
examine 0 '{a:/steps/0/rms} * -3 ^ 2 / (1 + 2) - 2' 'reference: -8, absolute: 1e-12, origin: analytic'
examine 0 'max({a:/steps/two/list} - 1)' 'reference: 3, relative: 0, origin: analytic'
examine 0 'sum({a:/steps/two/passes/*/rms})' 'reference: 12, relative: 0, origin: analytic'
examine 0 'size({a:nodes.csv#x?group=net&id<=2})' 'reference: 2, relative: 0, origin: analytic'
examine 0 'size({a:nodes.csv#x?group=net&id>=2&id<=2})' 'reference: 1, relative: 0, origin: analytic'
examine 0 'max({a:nodes.csv#x?within=5})' 'reference: 3, relative: 0, origin: analytic'
examine 0 '{a:/steps/one/rms}' 'at_most: 2, origin: requirement'
examine 0 '{a:/steps/one/rms}' 'at_most: 2, origin: invariant'
examine 1 '{a:/steps/one/rms}' 'at_most: 1.9, origin: requirement'
examine 1 '{a:/steps/one/rms}' 'reference: 2.01, relative: 0.004, origin: analytic'
examine 1 '{a:/steps/one/lost}' 'reference: 2, relative: 1, origin: analytic'
examine 1 '{a:/steps/two/list}' 'reference: 2, relative: 1, origin: analytic'
examine 1 '{a:/steps/one/rms} / 0' 'reference: 2, relative: 1, origin: analytic'
examine 1 '{a:/steps/one/rms}' 'reference: 2.2, relative: 0.2, origin: published, source: s'
says "$WORK/out" 'without a note'
examine 0 '{a:/steps/one/rms}' 'reference: 2.2, relative: 0.2, origin: published, source: s, note: why'
examine 2 '{a:/steps/one/rms}' 'reference: 2, origin: analytic'
examine 2 '{a:/steps/one/rms}' 'reference: 2, report_only: true, origin: analytic'
examine 2 '{a:/steps/one/rms}' 'reference: 2, relative: 1, origin: published'
examine 2 '{a:/steps/one/rms}' 'reference: 2, relative: 1, origin: heard'

# The list behind docs/thesis.md: figures that nothing covers are named, and so are runs and quantities that are not there.
list=$WORK/source/verification/thesis/thesis.yaml
mkdir -p "$(dirname "$list")"
examine 0 '{a:/steps/one/rms}' 'reference: 2, relative: 1e-9, origin: analytic'
# thesis CODE ITEM: a list of one item, and this exit code.
thesis() {
  printf 'introduction: text\ncases: {made_up: short}\nchapters:\n  - {title: t, items: [{item: Figure 3.22, covers: "3.22", about: x, %s}]}\n' "$2" >"$list"
  expect "$1" "$THESIS" --source "$WORK/source"
}
thesis 1 'rows: [{case: made_up, quantity: q}]'
says "$WORK/out" 'no item covers 4.25'
if grep -q 'covers 3.22' "$WORK/out"; then fail "3.22 is covered"; fi
thesis 1 'status: shown only, charts: [{file: f, title: t, x: x, y: y, curves: [{label: l, y: "{made_up.b:/steps/0/rms}"}]}]'
says "$WORK/out" 'no run "made_up.b"'
thesis 1 'text: nothing'
says "$WORK/out" 'rows or a status'
thesis 2 'rows: [{case: made_up, quantity: lost}]'
says "$WORK/err" 'no quantity "lost"'
done_testing
