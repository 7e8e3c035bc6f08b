# SPDX-License-Identifier: MIT
"""canmatrix_oracle.py FILE.dbc: reads "id-with-flag hex-data" lines, prints "message.signal value"
of every signal present, with python3-canmatrix; then a line "."."""
import sys
import canmatrix.formats

matrix = canmatrix.formats.loadp_flat(sys.argv[1])
for line in sys.stdin:
    number, data = line.split()
    number = int(number)
    wanted = canmatrix.ArbitrationId(number & 0x1FFFFFFF, extended=bool(number & 0x80000000))
    frame = matrix.frame_by_id(wanted)
    for name, decoded in frame.decode(bytes.fromhex(data)).items():
        signal = decoded.signal
        print(f"{frame.name}.{name} {decoded.raw_value!r} {float(signal.factor)!r} {float(signal.offset)!r}")
    print(".")
