before() { command -v man >/dev/null || lacks "man"; }
expected='
Usage: framewatch replay
--write-expect FILE
FRAMEWATCH-REPLAY\(1\)
'
