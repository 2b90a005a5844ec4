//! The place of the start on maps, and the direction of the flight.

use std::str::FromStr;

/// Length of a degree of latitude \[m\].
const DEGREE: f64 = 111_319.49;
/// Greatest latitude \[deg\]. Nearer to a pole a degree of longitude is too short for a straight flight.
const NORTHERNMOST: f64 = 85.0;

/// The place on the ground below the start, and the heading in which the vehicle flies straight on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Home {
    /// Latitude \[deg\].
    latitude: f64,
    /// Longitude \[deg\].
    longitude: f64,
    /// Altitude above the sea \[m\].
    pub(super) altitude: f64,
    /// Heading from north to east \[deg\].
    pub(super) heading: f64,
}

impl Home {
    /// The place and altitude at which PX4's simulations start, in Zurich, headed north.
    pub const ZURICH: Self = Self {
        latitude: 47.397_742,
        longitude: 8.545_594,
        altitude: 488.0,
        heading: 0.0,
    };

    /// Latitude and longitude of a place downrange \[1e-7 deg\].
    pub(super) fn place(&self, downrange: f64) -> [i32; 2] {
        let [north, east] = self.north_east(downrange);
        let parallel = DEGREE * libm::cos(self.latitude.to_radians());
        let longitude = (self.longitude + east / parallel + 180.0).rem_euclid(360.0) - 180.0;
        [self.latitude + north / DEGREE, longitude].map(|degrees| (degrees * 1e7).round() as i32)
    }

    /// The parts to the north and to the east of what is downrange.
    pub(super) fn north_east(&self, downrange: f64) -> [f64; 2] {
        let (east, north) = libm::sincos(self.heading.to_radians());
        [downrange * north, downrange * east]
    }

    /// Altitude above the sea of a height \[mm\].
    pub(super) fn millimetres(&self, height: f64) -> i32 {
        ((self.altitude + height) * 1e3).round() as i32
    }

    /// The heading as an angle from -pi to pi \[rad\].
    pub(super) fn yaw(&self) -> f64 {
        let half = if self.heading > 180.0 { 360.0 } else { 0.0 };
        (self.heading - half).to_radians()
    }
}

impl FromStr for Home {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|one| one.trim().parse()).collect();
        let ranges = [
            -NORTHERNMOST..=NORTHERNMOST,
            -180.0..=180.0,
            -500.0..=9000.0,
            0.0..=360.0,
        ];
        match numbers.as_deref() {
            Ok(&[latitude, longitude, altitude, heading])
                if [latitude, longitude, altitude, heading]
                    .iter()
                    .zip(ranges)
                    .all(|(number, range)| range.contains(number)) =>
            {
                Ok(Self {
                    latitude,
                    longitude,
                    altitude,
                    heading,
                })
            }
            _ => Err(format!(
                "give LAT,LON,ALT,HEADING: degrees from -{NORTHERNMOST} to {NORTHERNMOST} and from -180 to 180, \
                 metres above the sea from -500 to 9000, degrees from 0 to 360"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heading_says_where_downrange_is() {
        let north = Home::ZURICH.place(0.0);
        assert_eq!(north, [473_977_420, 85_455_940]);
        let east: Home = "0,179.9999, 10 ,90".parse().unwrap();
        // A degree of longitude at the equator; the date line is on the way.
        let [latitude, longitude] = east.place(DEGREE);
        assert_eq!((latitude, longitude), (0, -1_790_001_000));
        let north_west: Home = "47,8,0,315".parse().unwrap();
        let [north, west] = north_west.north_east(1.0);
        assert!((north - 0.5_f64.sqrt()).abs() < 1e-12 && (north + west).abs() < 1e-12);
        assert!((north_west.yaw() + std::f64::consts::FRAC_PI_4).abs() < 1e-12);
    }

    #[test]
    fn what_is_no_place_is_refused() {
        for text in [
            "",
            "47,8,488",
            "47,8,488,0,0",
            "86,8,488,0",
            "47,181,488,0",
            "47,8,1e5,0",
            "47,8,488,361",
            "47,8,nan,0",
            "47,8,x,0",
        ] {
            assert!(text.parse::<Home>().is_err(), "{text}");
        }
        assert_eq!("47.397742,8.545594,488,0".parse(), Ok(Home::ZURICH));
    }
}
