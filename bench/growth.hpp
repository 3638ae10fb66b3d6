#pragma once

#include "race.hpp"

namespace surfgrad::bench {

/// How the cost grows: one function a question.
void race_layers(const Request& request);
void race_decals(const Request& request);
void race_threads(const Request& request);
void race_sizes(const Request& request);

/// What the program does as a child of itself: bakes on one thread whenever it is told to, and answers
/// with processor seconds, wall seconds, and the bytes of the process before the bake and at its peak.
void bake_when_told(int size, int map_size, int bits);

} // namespace surfgrad::bench
