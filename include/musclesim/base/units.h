/// All unit conversion factors. No other file holds any.
///
/// The ODE world and the building API use mm, g, s and degrees; forces cross the API in N, pressures as fractions of full scale (0..1).
#pragma once

#include <numbers>

namespace musclesim {

inline constexpr double mm_per_m = 1000.0;
inline constexpr double mm_per_cm = 10.0;
inline constexpr double g_per_kg = 1000.0;
inline constexpr double s_per_min = 60.0;
inline constexpr double ms_per_s = 1000.0;
inline constexpr double s_per_us = 1e-6;
inline constexpr double kPa_per_bar = 100.0;
inline constexpr double kPa_per_MPa = 1000.0;
inline constexpr double kPa_per_Pa = 1e-3;
inline constexpr double kPa_per_hPa = 0.1;
inline constexpr double kPa_per_mbar = 0.1;
inline constexpr double kPa_per_psi = 6.894757293168361;
inline constexpr double mm_per_um = 1e-3;
inline constexpr double mm_per_inch = 25.4;
inline constexpr double N_per_mN = 1e-3;
inline constexpr double N_per_kN = 1000.0;
inline constexpr double N_per_lbf = 4.4482216152605;
inline constexpr double rad_per_deg = std::numbers::pi / 180.0;
inline constexpr double deg_per_rad = 180.0 / std::numbers::pi;

/// Standard acceleration of a falling body as the original program rounds it.
inline constexpr double gravity_m_per_s2 = 9.81;
/// One kilogram-force in newton, rounded alike: the paper gives the loads of its experiment in kg.
inline constexpr double newton_per_kgf = 9.81;
/// The same as measuring instruments have it, by definition.
inline constexpr double newton_per_standard_kgf = 9.80665;

/// 1 N in g mm/s^2: the unit of force of a world in mm, g, s.
inline constexpr double world_force_per_N = mm_per_m * g_per_kg;
/// 1 kg m^2 in g mm^2.
inline constexpr double g_mm2_per_kg_m2 = g_per_kg * mm_per_m * mm_per_m;
/// The original program used forces and gravity that are this factor too small for mm, g and s, so it ran sqrt(1000) times too slowly.
inline constexpr double original_force_deficit_ratio = 1000.0;

}  // namespace musclesim
