#pragma once
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace support {

/// Size of the spectrum of a signal with this step (s) at a frequency (Hz), with Hann's window.
inline double strength(const std::vector<double>& signal, double step, double frequency) {
  const double angle = 2 * std::numbers::pi * frequency * step, size = static_cast<double>(signal.size());
  const std::complex<double> turn(std::cos(angle), std::sin(angle));
  std::complex<double> sum = 0, phase = 1;
  for (std::size_t k = 0; k < signal.size(); ++k) {
    sum += (0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(k) / size)) * signal[k] * phase;
    phase *= turn;
  }
  return std::abs(sum);
}

/// Where the spectrum has its peak within 2 % of a frequency: a scan, then a parabola through the best three.
inline double peak(const std::vector<double>& signal, double step, double about) {
  constexpr int half = 20;
  double best = 0;
  int at = 0;
  const auto frequency = [&](int k) { return about * (1 + 0.02 * k / half); };
  for (int k = -half; k <= half; ++k)
    if (const double now = strength(signal, step, frequency(k)); now > best) {
      best = now;
      at = k;
    }
  const double low = strength(signal, step, frequency(at - 1)), high = strength(signal, step, frequency(at + 1));
  const double shift = 0.5 * (low - high) / (low - 2 * best + high);
  return frequency(at) + shift * (frequency(1) - frequency(0));
}

}  // namespace support
