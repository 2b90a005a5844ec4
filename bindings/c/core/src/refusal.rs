//! The number for which a configuration was refused.

use core::ffi::c_char;
use core::fmt::{self, Write};
use mpp_core::settings::Setting;

/// Room for the text of a name or a unit, its end included [bytes].
pub const MPP_TEXT: usize = 64;

/// A number that `mpp_set_up` has refused.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MppRefusal {
    /// Its name in the core; empty if no number was out of its range. Behind `airframe.` and `actuators.` stands the
    /// name of the field of the aircraft.
    pub name: [c_char; MPP_TEXT],
    /// Its unit; 1 for a number without one.
    pub unit: [c_char; MPP_TEXT],
    /// Least value.
    pub least: f64,
    /// Greatest value.
    pub most: f64,
}

impl MppRefusal {
    pub(crate) const NOTHING: Self = Self {
        name: [0; MPP_TEXT],
        unit: [0; MPP_TEXT],
        least: 0.0,
        most: 0.0,
    };
}

impl From<Setting> for MppRefusal {
    fn from(setting: Setting) -> Self {
        let mut refused = Self::NOTHING;
        [refused.least, refused.most] = setting.range();
        // A text without room is cut, which is no failure.
        let _ = write!(Text::in_place(&mut refused.name), "{setting}");
        let _ = Text::in_place(&mut refused.unit).write_str(setting.unit());
        refused
    }
}

/// A text that is written to a place of zeros. The last of them stays, as its end.
struct Text<'a>(core::iter::Take<core::slice::IterMut<'a, c_char>>);

impl<'a> Text<'a> {
    fn in_place(place: &'a mut [c_char; MPP_TEXT]) -> Self {
        Self(place.iter_mut().take(MPP_TEXT - 1))
    }
}

impl Write for Text<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for (place, letter) in self.0.by_ref().zip(text.bytes()) {
            *place = letter as c_char;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use core::ffi::CStr;
    use std::string::ToString;

    fn read(text: &[c_char; MPP_TEXT]) -> std::string::String {
        let bytes = text.map(|letter| letter as u8);
        let text = CStr::from_bytes_until_nul(&bytes).unwrap();
        text.to_str().unwrap().to_string()
    }

    #[test]
    fn every_number_has_room_for_its_name_and_unit() {
        for setting in Setting::ALL {
            let refused = MppRefusal::from(*setting);
            assert_eq!(read(&refused.name), setting.to_string());
            assert_eq!(read(&refused.unit), setting.unit());
            let range = [refused.least, refused.most].map(f64::to_bits);
            assert_eq!(range, setting.range().map(f64::to_bits));
        }
    }
}
