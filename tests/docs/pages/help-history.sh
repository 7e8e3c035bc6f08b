. "$here/history.sh"
expected='
^raw samples from 2026-11-21T17:00:00Z.* 1 log
  kx_1_y1 +3[34][0-9]+
^Samples: [56][0-9]+ received on 10 channels, [0-9]+ lost
^quake.mseed: [56][0-9]+ samples of 10 channels
'
