#include "arcslip/time/disturbed_wave.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace arcslip {

Index disturbed_wave(const std::vector<WavePlace>& places, const ComplexVector& vector, Index nodes) {
  struct Share {
    double energy = 0;
    double turning = 0;
  };
  std::map<Index, Share> shares;
  const auto add = [&](const WavePlace& place, Index wave, const Complex& p, const Complex& v) {
    Share& share = shares[(wave % nodes + nodes) % nodes];
    share.energy += std::norm(place.scale * v) + std::norm(place.frequency * p);
    share.turning += place.scale * place.scale * std::imag(std::conj(p) * v);
  };
  for (const WavePlace& place : places) {
    const Complex p = vector(place.position);
    const Complex v = vector(place.velocity);
    if (!place.is_real) {
      add(place, place.wave, p, v);
      continue;
    }
    const Complex p_turned = Complex(0, 1) * vector(place.position + 1);
    const Complex v_turned = Complex(0, 1) * vector(place.velocity + 1);
    add(place, place.wave, p + p_turned, v + v_turned);
    add(place, -place.wave, p - p_turned, v - v_turned);
  }
  if (shares.empty()) return 0;
  const auto most = std::max_element(shares.begin(), shares.end(), [](const auto& a, const auto& b) {
    return a.second.energy < b.second.energy;
  });
  const auto& [wave, share] = *most;
  const bool stands = std::abs(share.turning) <= 1e-9 * share.energy;
  const bool turns = stands ? 2 * wave > nodes : share.turning < 0;
  return turns ? (nodes - wave) % nodes : wave;
}

}  // namespace arcslip
