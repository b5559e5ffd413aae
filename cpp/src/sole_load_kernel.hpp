// Wrench, generalised torques and centre of pressure of a bush, from its force sensor, for samples [begin, end).
#pragma once

#include "pack.hpp"
#include "sole_load.hpp"
#include "vec3.hpp"

namespace plantar::PLANTAR_ISA {

PLANTAR_INLINE void sole_load_pack(const SoleLoad& load, std::size_t first, std::size_t last, double* const* out) {
  const auto three = [&](const Column* c) {
    return Vec3{gather(c[0], first, last), gather(c[1], first, last), gather(c[2], first, last)};
  };
  const auto write = [&](int row, Lanes x) { scatter(out[row] + first, x, last - first); };
  const Vec3 up = three(load.up), force = load.sign * turned(load.sensor.rotation, three(load.reading));
  const Vec3 torque = load.sign * turned(load.sensor.rotation, three(load.reading + 3)) +
                      cross(splat3(load.sensor.origin), force);
  write(WRENCH, force.x), write(WRENCH + 1, force.y), write(WRENCH + 2, force.z);
  write(WRENCH + 3, torque.x), write(WRENCH + 4, torque.y), write(WRENCH + 5, torque.z);
  write(FORCE_Z, dot(up, force));

  // The pitch axis is fixed to the ankle; the roll axis turns with the pitch. Sines and cosines come from `up`.
  const Lanes level = sqrt(up.x * up.x + up.z * up.z), cp = up.z / level, sp = up.x / level;
  write(TORQUE, torque.y);
  write(TORQUE + 1, cp * torque.x - sp * torque.z);

  // Where the ground's force passes through the sole's plane; both turned into the deflected frame first.
  const auto deflected = [&](Vec3 a) {
    const Lanes along = sp * a.x + cp * a.z;
    return Vec3{cp * a.x - sp * a.z, level * a.y - up.y * along, level * along + up.y * a.y};
  };
  const Vec3 push = deflected(force), moment = deflected(torque) - cross(splat3(load.sole.origin), push);
  const Vec3 about = turned_back(load.sole.rotation, moment);
  const Lanes along_normal = turned_back(load.sole.rotation, push).z;
  const Lanes normal = along_normal >= load.least ? along_normal : splat(__builtin_nan(""));
  write(COP, -about.y / normal);
  write(COP + 1, about.x / normal);
}

inline void sole_load(const SoleLoad& load, std::size_t begin, std::size_t end, double* const* out) {
  for (std::size_t first = begin; first < end; first += LANES) sole_load_pack(load, first, end, out);
}

}  // namespace plantar::PLANTAR_ISA
