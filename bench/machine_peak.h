#pragma once

#include <benchmark/benchmark.h>

namespace remomask {

/// Bytes per second at which this machine reads memory outside the caches, with OpenMP's current
/// number of threads: the best of several passes over 128 MB. Measured once for each number of
/// threads.
double memory_read_rate();

/// FLOP per second of single-precision GEMM (1024^3, the program's own BLAS) with the current
/// number of threads: the best of several passes. The thread numbers of OpenMP and the BLAS must
/// agree. Measured once for each number of threads.
double gemm_rate();

/// Adds the counters `floor_ms`, the minimum time of one iteration, and `x_floor`, how many times
/// that one iteration took (shown with an "s").
void report_floor(benchmark::State& state, double floor_seconds);

/// Adds the counters `FLOP` (per second) of iterations of `flops`, `peak_FLOP/s`
/// and those of report_floor() for arithmetic at the peak.
void report_arithmetic(benchmark::State& state, double flops);

/// Milliseconds, real time, a warm-up, and the medians of seven repetitions.
void with_medians(benchmark::internal::Benchmark* bench);

}  // namespace remomask
