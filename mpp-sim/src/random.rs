//! Seeded random numbers, the same on every machine.
//!
//! Each subsystem draws from its own stream of the flight's seed. Another number of lidar beams
//! therefore does not change the airspeed noise.

use chacha20::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// The subsystems that draw random numbers. The number selects the generator's stream. It is part
/// of the meaning of a seed, so it never changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stream {
    /// Heights of the obstacles.
    Field = 1,
    /// Airspeed sensor noise.
    AirspeedSensor = 2,
    /// Pitch sensor noise.
    PitchSensor = 3,
    /// Lidar range noise.
    Lidar = 4,
    /// Signs of the airframe's errors.
    ModelError = 5,
    /// Motion of the air.
    Gusts = 6,
    /// Lidar dropouts and false hits.
    LidarFaults = 7,
    /// Place of a challenge scene.
    Scene = 8,
    /// Errors of the navigation source.
    Navigation = 9,
    /// Noise of a faulty airspeed sensor.
    AirspeedFault = 10,
    /// Noise of a faulty pitch sensor.
    PitchFault = 11,
    /// Noise of a faulty position downrange.
    XFault = 12,
    /// Noise of a faulty height.
    ZFault = 13,
    /// Noise of a faulty elevator.
    ElevatorFault = 14,
    /// Noise of a faulty thrust.
    ThrustFault = 15,
    /// Messages that are lost.
    LinkFault = 16,
    /// Places and sizes of the obstacles of fields that are not the paper's.
    Generator = 17,
    /// Directions of moving obstacles.
    Motion = 18,
    /// Sideways and rolling motion of the air.
    LateralGusts = 19,
    /// Pairs of faults of a campaign.
    FaultPairs = 20,
    /// Directions, noise and faults of a lidar in space.
    SpaceLidar = 21,
    /// Errors of the estimate in space.
    SpaceEstimate = 22,
    /// Bodies of a world in space.
    Bodies = 23,
    /// Trees of the paper's method in space.
    Trees = 24,
}

/// The generator of one subsystem: ChaCha with 8 rounds. It has the bits of `rand_chacha`, which is slower to build.
#[derive(Debug)]
pub struct Draws(ChaCha8Rng);

/// The library's generator cannot be copied, so that nobody uses the numbers of a cipher twice. A copied flight must.
impl Clone for Draws {
    fn clone(&self) -> Self {
        let mut copy = ChaCha8Rng::from_seed(self.0.get_seed());
        copy.set_stream(self.0.get_stream());
        copy.set_word_pos(self.0.get_word_pos());
        Self(copy)
    }
}

/// The generator of one subsystem in the flight with this seed.
#[must_use]
pub fn generator(seed: u64, stream: Stream) -> Draws {
    let mut generator = ChaCha8Rng::seed_from_u64(seed);
    generator.set_stream(stream as u64);
    Draws(generator)
}

/// A uniform random number in `[0, 1)`, on the grid of `2^-53`.
#[must_use]
pub fn uniform(generator: &mut Draws) -> f64 {
    const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
    (generator.0.next_u64() >> 11) as f64 * STEP
}

/// A standard normal random number, by Box and Muller's transform.
///
/// The transform is written out over `libm`, because `rand_distr` may call the platform's
/// logarithm, whose bits differ between machines. The second value of the pair is thrown away, so
/// that the generator's position is the only state.
#[must_use]
pub fn gaussian(generator: &mut Draws) -> f64 {
    // 1 - u is in (0, 1]: its logarithm is finite.
    let radius = (-2.0 * libm::log(1.0 - uniform(generator))).sqrt();
    radius * libm::cos(core::f64::consts::TAU * uniform(generator))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Stream; 24] = [
        Stream::Field,
        Stream::AirspeedSensor,
        Stream::PitchSensor,
        Stream::Lidar,
        Stream::ModelError,
        Stream::Gusts,
        Stream::LidarFaults,
        Stream::Scene,
        Stream::Navigation,
        Stream::AirspeedFault,
        Stream::PitchFault,
        Stream::XFault,
        Stream::ZFault,
        Stream::ElevatorFault,
        Stream::ThrustFault,
        Stream::LinkFault,
        Stream::Generator,
        Stream::Motion,
        Stream::LateralGusts,
        Stream::FaultPairs,
        Stream::SpaceLidar,
        Stream::SpaceEstimate,
        Stream::Bodies,
        Stream::Trees,
    ];

    #[test]
    fn a_seed_means_the_same_numbers_for_ever() {
        let first = ALL.map(|stream| generator(7, stream).0.next_u64());
        assert_eq!(
            first,
            [
                18_301_176_669_829_311_175,
                5_536_391_431_806_027_785,
                3_348_856_302_973_006_449,
                18_244_131_744_192_737_788,
                12_716_886_768_273_581_270,
                6_788_621_307_340_148_322,
                12_947_559_667_725_341_916,
                18_116_008_155_350_138_704,
                10_998_222_350_071_771_533,
                14_454_029_882_420_853_398,
                9_565_470_705_248_308_949,
                4_789_873_397_465_613_025,
                3_239_095_324_188_114_646,
                17_143_269_106_807_000_846,
                18_074_614_959_641_999_106,
                15_842_934_994_030_001_981,
                15_784_797_038_420_267_861,
                13_531_319_370_983_182_927,
                5_256_132_873_963_308_690,
                12_220_099_047_758_517_520,
                627_886_748_865_932_386,
                13_253_704_345_110_291_491,
                8_756_309_045_004_367_201,
                2_383_762_860_634_698_027,
            ]
        );
    }

    /// Past the end of two of the library's buffers.
    #[test]
    fn a_copy_draws_the_same_numbers() {
        let fresh = || generator(5, Stream::Lidar);
        let mut original = fresh();
        for drawn in 0..100 {
            let mut copy = original.clone();
            let mut expected = fresh();
            for _ in 0..drawn {
                expected.0.next_u64();
            }
            for _ in 0..50 {
                assert_eq!(copy.0.next_u64(), expected.0.next_u64());
            }
            original.0.next_u64();
        }
    }

    #[test]
    fn streams_of_one_seed_are_uncorrelated() {
        const COUNT: usize = 20_000;
        let draws = ALL.map(|stream| {
            let mut generator = generator(3, stream);
            (0..COUNT)
                .map(|_| gaussian(&mut generator))
                .collect::<Vec<_>>()
        });
        for a in 0..ALL.len() {
            for b in 0..a {
                let product: f64 = draws[a].iter().zip(&draws[b]).map(|(x, y)| x * y).sum();
                let correlation = product / COUNT as f64;
                // Four standard errors.
                assert!(correlation.abs() < 4.0 / (COUNT as f64).sqrt());
            }
        }
    }

    #[test]
    fn gaussian_has_the_moments_of_a_standard_normal() {
        const COUNT: usize = 200_000;
        let mut generator = generator(0, Stream::Lidar);
        let mut sums = [0.0; 4];
        let mut beyond_two_sigma = 0;
        for _ in 0..COUNT {
            let value = gaussian(&mut generator);
            let square = value * value;
            for (sum, power) in
                sums.iter_mut()
                    .zip([value, square, square * value, square * square])
            {
                *sum += power / COUNT as f64;
            }
            beyond_two_sigma += usize::from(value.abs() > 2.0);
        }
        for (sum, (expected, tolerance)) in
            sums.into_iter()
                .zip([(0.0, 0.01), (1.0, 0.015), (0.0, 0.04), (3.0, 0.1)])
        {
            assert!(
                (sum - expected).abs() < tolerance,
                "{sum} instead of {expected}"
            );
        }
        let share = beyond_two_sigma as f64 / COUNT as f64;
        assert!((share - 0.0455).abs() < 0.002, "{share}");
    }

    #[test]
    fn uniform_stays_below_one() {
        let mut generator = generator(1, Stream::Field);
        for _ in 0..100_000 {
            assert!((0.0..1.0).contains(&uniform(&mut generator)));
        }
    }
}
