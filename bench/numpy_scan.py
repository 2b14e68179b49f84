"""Exact top-10 among 100,000 vectors of 512 numbers with NumPy, for 1 and 64
queries: the work of search_bench in the way of a Python program. Prints the
median of several passes in milliseconds of real time and of processor time."""

import statistics
import time

import numpy

COUNT, WIDTH, NEAREST, PASSES = 100_000, 512, 10, 21


def unit_vectors(count, seed):
    vectors = numpy.random.default_rng(seed).uniform(-1, 1, (count, WIDTH)).astype(numpy.float32)
    return vectors / numpy.linalg.norm(vectors, axis=1, keepdims=True)


def nearest(vectors, queries):
    scores = queries @ vectors.T if len(queries) > 1 else (vectors @ queries[0])[None]
    found = numpy.argpartition(-scores, NEAREST, axis=1)[:, :NEAREST]
    order = numpy.argsort(-numpy.take_along_axis(scores, found, 1), axis=1)
    return numpy.take_along_axis(found, order, 1)


stored = unit_vectors(COUNT, 1)
for batch in (1, 64):
    asked = unit_vectors(batch, 2)
    real, processor = [], []
    for _ in range(PASSES):
        start = time.perf_counter(), time.process_time()
        nearest(stored, asked)
        real.append(time.perf_counter() - start[0])
        processor.append(time.process_time() - start[1])
    print(f"numpy {numpy.__version__} search/{batch}: median {1e3 * statistics.median(real):.1f} ms, "
          f"CPU {1e3 * statistics.median(processor):.1f} ms")
