#pragma once

/// Surface gradient based bump mapping: the whole core in one include.

#include <surfgrad/decal.hpp>
#include <surfgrad/derivative.hpp>
#include <surfgrad/fractal.hpp>
#include <surfgrad/frame.hpp>
#include <surfgrad/gradient.hpp>
#include <surfgrad/hex_tiles.hpp>
#include <surfgrad/moments.hpp>
#include <surfgrad/noise.hpp>
#include <surfgrad/noise_hash.hpp>
#include <surfgrad/parallax.hpp>
#include <surfgrad/parallax_march.hpp>
#include <surfgrad/power.hpp>
#include <surfgrad/resolve.hpp>
#include <surfgrad/scalar.hpp>
#include <surfgrad/screen.hpp>
#include <surfgrad/trigonometry.hpp>
#include <surfgrad/triplanar.hpp>
#include <surfgrad/vec.hpp>
#include <surfgrad/worley.hpp>
