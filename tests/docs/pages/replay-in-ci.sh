before() { ln -s "$root/configs" "$root/tests" .; }
expected='
'
