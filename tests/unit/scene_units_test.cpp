#include "core/scene/units.hpp"
#include "support/catch.hpp"

using namespace scree::core;

TEST_CASE("units convert to the double nearest to the written decimal") {
  // 35 * 0.001 is 0.035000000000000003 in binary64; 35 / 1000 rounds once.
  REQUIRE(units::convert(35, "mm", "m") == 0.035);
  REQUIRE(units::convert(4.5, "GPa", "Pa") == 4.5e9);
  REQUIRE(units::convert(60, "%", "1") == 0.6);
  REQUIRE(units::convert(2650, "kg/m3", "kg/m3") == 2650.0);
  REQUIRE(units::convert(-50, "mm/s", "m/s") == -0.05);
  REQUIRE(*units::convert(180, "deg", "rad") == Approx(3.14159265358979312).epsilon(1e-15));
  REQUIRE(*units::convert(60, "rpm", "rad/s") ==
          Approx(6.28318530717958648).epsilon(1e-14));  // BIPM: 1 turn = 2 pi rad
  REQUIRE(*units::convert(20, "degC", "K") == Approx(293.15).epsilon(1e-15));
  REQUIRE(units::to_si(25, "kPa") == 25000.0);
}

TEST_CASE("units keep dimensions apart, angles and pure numbers too") {
  REQUIRE_FALSE(units::convert(25, "kPa", "m"));
  REQUIRE_FALSE(units::convert(30, "deg", "1"));
  REQUIRE_FALSE(units::convert(50, "Hz", "rad/s"));
  REQUIRE(units::same_dimension("N m", "J"));
  REQUIRE_FALSE(units::same_dimension("N/m", "Pa"));
  REQUIRE(units::dimension("kPa") == "a pressure");
  REQUIRE(units::dimension("mm") == "a length");
  REQUIRE(units::dimension("deg") == "an angle");
  REQUIRE(units::dimension("t/m3") == "a density");
}

TEST_CASE("units refuse what UDUNITS would read as something else") {
  for (const char* const text : {"", "Nm", "furlongz", "m since 2000-01-01", "2 mm", "lg(re 1 mW)", "m;m", "@ 3"}) {
    INFO(text);
    REQUIRE_FALSE(units::known(text));
  }
  REQUIRE(units::known("J/(kg K)"));
  REQUIRE(units::known("1/s"));
  REQUIRE_FALSE(units::known(std::string(500, 'm')));
}

TEST_CASE("every unit of the table in docs/units.md is known") {
  for (const char* const text :
       {"km",   "cm",   "mm",    "um",  "nm",  "inch", "ft",    "g",   "t",   "ms",   "us",   "ns",
        "min",  "h",    "kN",    "MN",  "kPa", "MPa",  "GPa",   "bar", "psi", "kN/m", "MN/m", "g/cm3",
        "t/m3", "mm/s", "mm/s2", "deg", "°",   "mrad", "deg/s", "rpm", "Hz",  "kHz",  "N m",  "N.m",
        "N*m",  "J",    "kN m",  "kJ",  "K",   "degC", "%",     "m^2", "s-1"}) {
    INFO(text);
    REQUIRE(units::known(text));
  }
  REQUIRE(units::to_si(1, "min") == 60.0);
  REQUIRE(units::to_si(1, "h") == 3600.0);
  REQUIRE(units::to_si(1, "t") == 1000.0);
}
