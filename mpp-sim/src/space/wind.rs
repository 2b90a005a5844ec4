//! Wind on three axes: steady, sheared, and with gusts.
//!
//! Shear and gusts are those of MIL-F-8785C for low altitude (sections 3.7.3.2 and 3.7.3.4). Longitudinal and vertical gusts are
//! the [`Gusts`] of flights in the vertical plane. To them come the sideways gust and the rolling of the air over the span `b`:
//!
//! ```text
//! sideways  H_v(s) = sigma_v sqrt(L_v / (pi V)) (1 + sqrt(3) s L_v / V) / (1 + s L_v / V)^2,  L_v = L_u, sigma_v = sigma_u
//! rolling   H_p(s) = sigma_w sqrt(0.8 / V) (pi / 4b)^(1/6) / (L_w^(1/3) (1 + s 4b / (pi V)))
//! shear     w(h) = w(50 m) ln(h / z0) / ln(50 m / z0)
//! ```
//!
//! The gusts in pitch rate and yaw rate of the standard are left out: they are derivatives of those along and across.

use crate::faults::{
    DoubleLag, GUST_AIRSPEED, GustConfig, Gusts, HEIGHT, Lag, longitudinal_length,
    longitudinal_ratio,
};
use crate::random::{self, Draws, Stream};
use core::f64::consts::PI;

/// Height below which the shear ends \[m\]: 3 feet.
const LEAST_HEIGHT: f64 = 0.9144;

/// The wind beside the gusts in the vertical plane. By default there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WindConfig {
    /// Motion of the air ahead, to the right and up, at a height of 50 m [m/s].
    pub steady: [f64; 3],
    /// Roughness of the ground \[m\], by which the wind ahead and to the right grows with the height; the standard has 0.046
    /// (0.15 feet) near runways and 0.61 (2 feet) elsewhere. Without a value the wind is the same at each height.
    pub roughness: Option<f64>,
    /// Standard deviation of the vertical gusts to which sideways and rolling gusts belong [m/s].
    pub lateral_gusts: f64,
}

/// The air of one flight.
#[derive(Clone, Debug)]
pub struct SpaceWind {
    config: WindConfig,
    plane: Option<Gusts>,
    lateral: Option<LateralGusts>,
}

#[derive(Clone, Debug)]
struct LateralGusts {
    sideways: DoubleLag,
    rolling: Lag,
    /// Standard deviations [m/s], [rad/s].
    sigma: [f64; 2],
    generator: Draws,
}

impl SpaceWind {
    /// The air of the flight with this seed around an aircraft with this span \[m\], sampled every `dt` \[s\]; `None` in
    /// still air.
    #[must_use]
    pub fn new(
        seed: u64,
        plane: GustConfig,
        config: WindConfig,
        span: f64,
        dt: f64,
    ) -> Option<Self> {
        let wind = Self {
            config,
            plane: Gusts::new(seed, plane, dt),
            lateral: (config.lateral_gusts > 0.0)
                .then(|| LateralGusts::new(seed, config.lateral_gusts, span, dt)),
        };
        let moves = config.steady.iter().any(|it| it.abs() > 0.0)
            || wind.plane.is_some()
            || wind.lateral.is_some();
        moves.then_some(wind)
    }

    /// Motion of the air ahead, to the right and up at a height \[m\] now [m/s].
    #[must_use]
    pub fn at(&self, height: f64) -> [f64; 3] {
        let [x, y, z] = self.config.steady;
        let share = self.config.roughness.map_or(1.0, |z0| {
            libm::log(height.max(LEAST_HEIGHT.max(z0)) / z0) / libm::log(HEIGHT / z0)
        });
        let (along, up) = self.plane.as_ref().map_or((0.0, 0.0), Gusts::wind);
        let sideways = self
            .lateral
            .as_ref()
            .map_or(0.0, |it| it.sigma[0] * it.sideways.value());
        [share * x + along, share * y + sideways, z + up]
    }

    /// Roll rate of the air [rad/s].
    #[must_use]
    pub fn roll_rate(&self) -> f64 {
        self.lateral
            .as_ref()
            .map_or(0.0, |it| it.sigma[1] * it.rolling.value)
    }

    /// Advances by one sample.
    pub fn advance(&mut self) {
        if let Some(plane) = &mut self.plane {
            plane.advance();
        }
        if let Some(lateral) = &mut self.lateral {
            lateral.sideways.advance(&mut lateral.generator);
            lateral.rolling.advance(&mut lateral.generator);
        }
    }
}

impl LateralGusts {
    fn new(seed: u64, intensity: f64, span: f64, dt: f64) -> Self {
        let mut generator = random::generator(seed, Stream::LateralGusts);
        let tau = 4.0 * span / (PI * GUST_AIRSPEED);
        // The integral of |H_p|^2 over the frequency, as the standard counts variances.
        let shape = libm::cbrt(PI * HEIGHT / (4.0 * span)) * PI * PI / (8.0 * span);
        let variance = 0.8 / HEIGHT * shape;
        Self {
            sideways: DoubleLag::new(longitudinal_length() / GUST_AIRSPEED, dt, &mut generator),
            rolling: Lag::new(tau, dt, &mut generator),
            sigma: [
                intensity * longitudinal_ratio(),
                intensity * variance.sqrt(),
            ],
            generator,
        }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the same wind has the same bits")]
mod tests {
    use super::*;

    const DT: f64 = 0.01;

    fn windy(seed: u64, config: WindConfig) -> SpaceWind {
        SpaceWind::new(seed, GustConfig::default(), config, 2.0, DT).unwrap()
    }

    /// The variances of the standard, of 2,000 flights, within four standard errors.
    #[test]
    fn lateral_gusts_have_drydens_strength() {
        let config = WindConfig {
            lateral_gusts: 1.0,
            ..WindConfig::default()
        };
        for samples in [0, 200] {
            let (mut sideways, mut rolling) = (0.0, 0.0);
            for seed in 0..2000 {
                let mut wind = windy(seed, config);
                (0..samples).for_each(|_| wind.advance());
                sideways += wind.at(50.0)[1].powi(2) / 2000.0;
                rolling += wind.roll_rate().powi(2) / 2000.0;
            }
            let expected = longitudinal_ratio().powi(2);
            assert!((sideways / expected - 1.0).abs() < 0.13, "{sideways}");
            // By hand for b = 2 m: sigma_p = 0.169 rad/s for each m/s.
            assert!(
                (rolling.sqrt() / 0.1692 - 1.0).abs() < 0.07,
                "{}",
                rolling.sqrt()
            );
        }
    }

    #[test]
    fn wind_grows_with_the_height_and_has_its_value_at_fifty_metres() {
        let config = WindConfig {
            steady: [4.0, -3.0, 0.5],
            roughness: Some(0.05),
            lateral_gusts: 0.0,
        };
        let wind = windy(1, config);
        assert_eq!(wind.at(50.0), config.steady);
        let [x, y, z] = wind.at(5.0);
        let share = 100_f64.log10() / 1000_f64.log10();
        assert!((x - 4.0 * share).abs() < 1e-12 && (y + 3.0 * share).abs() < 1e-12);
        assert_eq!(z, 0.5);
        assert_eq!(wind.at(-3.0), wind.at(0.0));
        let same = windy(
            1,
            WindConfig {
                roughness: None,
                ..config
            },
        );
        assert_eq!(same.at(5.0), config.steady);
    }

    #[test]
    fn a_seed_has_its_own_gusts_and_still_air_none() {
        let none = SpaceWind::new(1, GustConfig::default(), WindConfig::default(), 2.0, DT);
        assert!(none.is_none());
        let config = WindConfig {
            lateral_gusts: 1.0,
            ..WindConfig::default()
        };
        let first = |seed| windy(seed, config).at(50.0);
        assert_eq!(first(1), first(1));
        assert_ne!(first(1), first(2));
    }
}
