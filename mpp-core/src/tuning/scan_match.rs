//! The monitor that compares a scan with the one before it.

/// Difference of two adjacent ranges up to which the beams met the same surface \[m\], without the next part. With a greater
/// one the gap between two obstacles is a surface. Source: chosen.
pub const ALIKE: f64 = 0.6;
/// Part of it that grows with the range [-]: three standard deviations of the difference of two errors of 1 %. Source: derived.
pub const ALIKE_SHARE: f64 = 0.04;
/// Distance from where a return was predicted up to which a return is that one \[m\], without the next part. With a
/// greater one scans in reverse order fit too. Source: chosen.
pub const OFF: f64 = 1.0;
/// Part of it that grows with the range [-], as [`ALIKE_SHARE`]. Source: derived.
pub const OFF_SHARE: f64 = 0.04;
/// Least range of a predicted return \[m\]. Nearer ones move too fast across the fan. Source: chosen.
pub const NEAR: f64 = 2.0;
/// Share of the sight within which returns are predicted [-]. Source: chosen.
pub const SIGHT_SHARE: f64 = 0.9;
/// Beams at either edge of the fan to which nothing is predicted [-]; an error of the pose moves it out of sight.
/// Source: derived.
pub const EDGE_BEAMS: f64 = 2.0;
/// Number of sectors of the fan [-]. A smaller sector holds fewer predictions, a larger one is seldom silent. Source: chosen.
pub const SECTORS: usize = 8;
/// Sum of misses in silent sectors from which on they count as blind [-]; a miss weighs as many beams as confirmed it, 1 or
/// 2. Three adjacent beams on one surface weigh 4. With 3 one clean flight of 100 was told. Source: D37.
pub const LEAST_SILENT: u32 = 4;
/// Misses from which on the reverse order is tried [-]. Source: D37.
pub const LEAST_MISSES: u32 = 3;
/// Hits by which the reverse order fits better than the one as sent before it is believed [-]. With 2 instead of 4, a poor
/// lidar was told in 3 of 60 flights, with 4 in none. Source: D37.
pub const LEAST_GAIN: u32 = 4;
/// Turns of a scan that are tried before something is held against the lidar, to either side, and the step between them in
/// beams. A return may be 1.5 beams from its prediction, so steps of 3 leave none out. With beams 1 deg apart they reach
/// 15 deg, which a pitch that sticks is wrong by before it is excluded. Source: derived.
pub const TURN_STEPS: i32 = 5;
/// See [`TURN_STEPS`]. Source: derived.
pub const TURN_STEP: f64 = 3.0;
/// A turn explains a scan if it makes hits of one in so many misses [-]. With more, a silent sector is explained by chance.
/// Source: chosen.
pub const TURN_PART: u32 = 2;
/// Number of ages of scans that are tried, 0 among them [-]. Source: D61.
pub const AGES: usize = 3;
/// Time between two of them \[ticks\]: 100 ms. An age half way between is made up for as well. Source: D61.
pub const AGE_STEP: u32 = 10;
/// Standard deviation of the place of a return about its prediction \[m\]: half of the way between two beams at 20 m, and the
/// errors of the poses. Source: derived.
pub const SPREAD: f64 = 0.25;
/// Part of it that grows with the range [-]: the errors of two ranges, and the way between two beams. Source: derived.
pub const SPREAD_SHARE: f64 = 0.02;
/// Greatest misfit of a return, in squared standard deviations [-]: two of them. Obstacles hide each other. Source: chosen.
pub const MOST_MISFIT: f64 = 4.0;
/// Mean misfit up to which an age explains a scan [-]. At the true age 98 % of the scans that tell ages apart have less. Without
/// it a pitch that sticks and beams in reverse order look like an age. Source: D61.
pub const EXPLAINS: f64 = 0.6;
/// Most that one scan may say for an age, as a difference of misfits [-]: less than [`OLDER`], so that one pose that jumps finds
/// no age. Source: D61.
pub const MOST_GAIN: f64 = 6.0;
/// Share of the sum of differences that the next scan leaves [-]. Source: chosen.
pub const KEPT: f64 = 0.9;
/// Sum of differences from which on another age counts as true [-]. Source: D61.
pub const OLDER: f64 = 10.0;
