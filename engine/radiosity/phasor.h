#pragma once
// Complex numbers of light, without the care for infinities that std::complex takes at each product.

#include <cmath>

namespace pmdsim {

struct Phasor {
  float re = 0.0f, im = 0.0f;

  Phasor &operator+=(const Phasor &b) {
    re += b.re;
    im += b.im;
    return *this;
  }
};

inline Phasor operator+(const Phasor &a, const Phasor &b) { return {a.re + b.re, a.im + b.im}; }
inline Phasor operator-(const Phasor &a, const Phasor &b) { return {a.re - b.re, a.im - b.im}; }
inline Phasor operator*(float s, const Phasor &a) { return {s * a.re, s * a.im}; }
inline Phasor operator*(const Phasor &a, const Phasor &b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
inline float norm(const Phasor &a) { return a.re * a.re + a.im * a.im; }
inline float abs(const Phasor &a) { return std::sqrt(norm(a)); }

// exp(j 2 pi turns), to 1e-6, for any number of turns below 2^20.
inline Phasor unit_phasor(double turns) {
  const double shift = 0x1.8p52;
  const auto part = static_cast<float>(turns - ((turns + shift) - shift)); // -1/2 to 1/2
  // Half the angle, which stays within a quarter turn of 0, and then doubled.
  const float y = 0.5f * part, u = y * y;
  const float s =
      y *
      (6.283185307f + u * (-41.34170224f +
                           u * (81.60524928f + u * (-76.70585975f + u * (42.05869394f - 15.09464258f * u)))));
  const float c =
      1.0f +
      u * (-19.73920880f + u * (64.93939402f + u * (-85.45681720f + u * (60.24464137f - 26.42625678f * u))));
  return {c * c - s * s, 2.0f * s * c};
}

} // namespace pmdsim
