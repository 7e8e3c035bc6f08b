# README's building, and its record, in a module of the same build as the program.
before() {
  package=$(dirname "$(realpath "$(command -v framewatch)")")/../python/package
  [ -e "$package/framewatch" ] || lacks "this build has no Python module (deploy/install-deps --with python)"
  /usr/bin/python3 -c 'import numpy' || lacks "no numpy (deploy/install-deps --with python)"
  /usr/bin/python3 -c 'import matplotlib' || lacks "no matplotlib (deploy/install-deps --with docs)"
  export PYTHONPATH=$package MPLBACKEND=agg PATH=/usr/bin:$PATH
  awk '/^```toml file=/ { sub(/.*=/, ""); out = $0; next } /^```/ { out = "" } out { print > out }' "$root/README.md"
  framewatch simulate shaken.toml --out record.csv --quiet
}
expected='
stiffness.png
'
