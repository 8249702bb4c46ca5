// Constants of the energy and area sections, for 32 nm; each with its source and how sure it is.
#pragma once

namespace sgs {

// Horowitz, "Computing's energy problem" (ISSCC 2014): at 45 nm fp32 add 0.9 pJ, multiply 3.7 pJ;
// 0.65 of it at 32 nm (scale factor: medium confidence).
constexpr double kMacPj = 0.65 * (0.9 + 3.7);

// Bitonic sorting unit of NeRArch-Sim (ISCA 2026, Table VI), 28 nm: 13.7 mW at 1 GHz for 8
// compare-exchanges a cycle; 0.65/0.55 from 28 to 32 nm.
constexpr double kCompareExchangePj = 13.7 / 8 * (0.65 / 0.55);

// Volume rendering unit of GSCore (ASPLOS 2024): 0.25 W for 64 pixels at 1 GHz, 28 nm; as above.
constexpr double kPixelBlendPj = 250.0 / 64 * (0.65 / 0.55);

// One step of a ray through the voxel tree: three plane times. One chunk bound against a group: the
// multiplications of chunk_test.cpp.
constexpr double kRayStepMacs = 6;
constexpr double kChunkTestMacs = 80;

// SRAM at 32 nm, pJ a bit read; writes 1.1 of it (medium confidence, to be replaced by CACTI).
constexpr double kSmallSramPjPerBit = 0.10;   // up to 8 KB: input and FIFO buffers
constexpr double kMiddleSramPjPerBit = 0.20;  // up to 32 KB: keys and sort buffers
constexpr double kLargeSramPjPerBit = 0.45;   // 250 KB: pixel state
constexpr double kWriteOverRead = 1.1;

// Leakage: 0.02 (low-power) to 0.2 mW/KB (high-performance); the geometric mean (low confidence).
constexpr double kSramLeakageMwPerKb = 0.063;

// StreamingGS Table 1 (0.79 mm2 for 4 HFUs of 32 MAC lanes; 2.53 mm2 for 64 rendering units;
// 0.042 mm2 for 2 sorting units; 0.06 mm2 for VSU) and 0.0055 mm2/KB of SRAM.
constexpr double kMacLaneMm2 = 0.79 / (4 * 32);
constexpr double kPixelLaneMm2 = 2.53 / 64;
constexpr double kSortingUnitMm2 = 0.021;
constexpr double kVsuMm2 = 0.06;
constexpr double kSramMm2PerKb = 0.0055;

}  // namespace sgs
