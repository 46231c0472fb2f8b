// Written by calibrate_segments; see test/benchmark/README.md. Do not edit.
#pragma once

#include "core/segmentation/merge_cues.h"

namespace pcl_symmetry {

// fitted: log odds per unit of each cue, by MergingEvidence, on the 130 meshes
// 1 11 121 123 125 127 129 13 131 133 135 137 139 141 143 145 147 149 15 151 153 155 157 159 17 181
// 183 185 187 189 19 191 193 195 197 199 201 203 205 207 209 21 211 213 215 217 219 23 241 243 245 247
// 249 25 251 253 255 257 259 27 29 3 301 303 305 307 309 31 311 313 315 317 319 321 323 325 327 329 33
// 331 333 335 337 339 35 361 363 365 367 369 37 371 373 375 377 379 381 383 385 387 389 39 391 393 395
// 397 399 5 61 63 65 67 69 7 71 73 75 77 79 81 83 85 87 89 9 91 93 95 97 99.
inline constexpr std::array<MergeWeights, 2> kMergeFit{{
    // concavity
    {1.06, 0.9183, -0.1785, -0.5387, -6.649, 0.328, -3.032,
     -1.84, 2.725, 0, 0, 0, 0, 0},
    // all
    {-2.804, 1.659, -0.8894, -0.3251, -4.536, 1.072, -3.197,
     -1.464, 2.044, -0.5522, 2.676, -4.439, 8.25, 0.6337}}};

}  // namespace pcl_symmetry
