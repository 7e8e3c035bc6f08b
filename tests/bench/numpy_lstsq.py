# SPDX-License-Identifier: MIT
"""numpy_lstsq.py ROWS COLUMNS: microseconds numpy's batch least squares takes for one window."""
import sys
import time

import numpy

rows, columns = int(sys.argv[1]), int(sys.argv[2])
random = numpy.random.default_rng(1)
a, b = random.standard_normal((rows, columns)), random.standard_normal(rows)
begin = time.process_time()
numpy.linalg.lstsq(a, b, rcond=None)
print(1e6 * (time.process_time() - begin))
