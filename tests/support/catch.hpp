#pragma once
// What tests include for Catch2 2.x, which Debian 12 packages.
#include <catch2/catch.hpp>
