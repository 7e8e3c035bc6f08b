before() { mkdir -p ~/.config/fish/completions; }
expected='
== .*help-completion.md
'
