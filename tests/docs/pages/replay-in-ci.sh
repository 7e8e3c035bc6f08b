before() { ln -s "$root/configs" "$root/tests" .; }
expected='
^as expected: 89 of tests/golden/expected.toml
^files: identical, byte by byte
the intact events are in repaired.lcmlog
'
