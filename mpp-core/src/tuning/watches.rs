//! The tuned numbers of the watches, which notice sensors and actuators that fail.

/// Trust in the sensors of the 100 Hz step.
pub mod sensors {
    /// Ticks after which a value that repeats to the last bit counts as missing: 50 ms. A sensor of 20 Hz or
    /// more may hold its values between; with noise a repetition by chance is far rarer. Source: D15.
    pub const FROZEN_TICKS: u8 = 5;
    /// Ticks without a good value, beyond the sensor's own period, after which a sensor is suspected [-]. One value
    /// that fails its gate is no fault. Source: chosen.
    pub const SUSPECTED_AFTER: u16 = 3;
    /// Ticks without a good value, beyond the sensor's own period, after which a sensor is excluded [-]: 0.2 s. Its values are then no longer used. Source: chosen.
    pub const EXCLUDED_AFTER: u16 = 20;
    /// Ticks with good values after which an excluded sensor is used again [-]: 0.5 s. A fault that blinks
    /// faster keeps the sensor excluded. Source: chosen.
    pub const RECOVERED_AFTER: u16 = 50;
    /// Values of the pitch that the filter refuses in a row, on a steady course, before it believes them [-]: 30
    /// ms. With a stuck elevator the aircraft does not turn as the filter expects. Source: D27.
    pub const BELIEVED_AFTER: u8 = 3;
    /// Greatest change of the pitch in a tick on a steady course \[rad\]: 5 rad/s, and six standard deviations of
    /// its noise. Source: derived.
    pub const MOST_TURN: f64 = 0.08;
    /// Greatest time between two positions of a healthy source \[ticks\]: 1 Hz is the slowest source.
    /// Source: derived.
    pub const POSITION_PERIOD: u16 = 100;
    /// Number of measurements in a row that must be late before the filter falls behind to their age [-]. With
    /// fewer a single late one costs the freshness of the others. Source: derived; 0.03 s of data.
    pub const LATE_MEASUREMENTS: u8 = 3;
    /// Longest time between two steps that the estimate is moved on by \[s\]. After a longer time the state
    /// is another one; the sensors tell it. Source: D15.
    pub const LONGEST_PREDICTION: f64 = 0.5;
    /// Longest time without steps after which the first position is believed at once \[s\]. After a longer time the
    /// filter of the positions restarts. Source: derived.
    pub const LONGEST_GAP: f64 = 3.0;
    /// Standard deviations of the sensors that tell lost steps from a jump of the clock [-]. If the motion differs
    /// from the last one by more, steps were lost; if by less, the clock jumped. With fewer a fast turn of one tick
    /// looks like lost steps. Source: derived; 1.8 deg of pitch.
    pub const CHANGED: f64 = 7.0;
    /// Standard deviation of the airspeed after lost steps, as a share of it [-]. Source: derived; the sensors
    /// must pass their gates.
    pub const GAP_AIRSPEED: f64 = 0.15;
    /// Standard deviation of pitch and flight path angle after lost steps \[rad\]. Source: derived.
    pub const GAP_ANGLE: f64 = 0.2;
    /// Standard deviation of the pitch rate after lost steps [rad/s]. Source: derived.
    pub const GAP_RATE: f64 = 0.5;
    /// Longest time after a jump of the time for which scans wait for a position that tells where the aircraft is
    /// \[s\]: three positions of a source of 10 Hz. Source: derived.
    pub const LONGEST_DOUBT: f64 = 0.3;
}

/// Bias of the pitch, seen as a steady vertical wind and a push along the way.
pub mod pitch_bias {
    /// Time over which the tilt is averaged \[s\]. More of it tells gusts better from a bias, and finds a bias
    /// later. Source: D16.
    pub const MEMORY: f64 = 3.0;
    /// Time after which the first estimate of the wind is settled \[s\]. Source: D26.
    pub const SETTLED: f64 = 0.5;
    /// Time after [`SETTLED`] after which a bias can be found \[s\]. Source: D26.
    pub const SEEN: f64 = 1.0;
    /// Least bias \[rad\]: 2.4 degrees. An error of the airframe looks like a smaller one. Source: D16.
    pub const LEAST: f64 = 0.042;
    /// Least ratio of the tilts by wind and by airspeed, the lesser to the greater [-]. With 0.6 two of 200 flights in
    /// gusts failed, with 0.7 one of 600, as without the watch. Source: D26.
    pub const AGREE: f64 = 0.7;
    /// Least change of the bias by which the estimates turn \[rad\]: 1.1 deg. With less they turn often.
    /// Source: chosen.
    pub const LEAST_TURN: f64 = 0.02;
    /// Standard deviation of the tilt by the estimated wind in still air \[rad\]. Source: D16.
    pub const STILL: f64 = 0.0083;
    /// Standard deviations of the tilt by the wind that a bias exceeds [-]. Fewer take gusts for a bias. Source: D26.
    pub const STEADY: f64 = 3.0;
}

/// Slow error of the airspeed, seen as wind and lift at once.
pub mod airspeed_bias {
    /// Time after which wind and lift are settled \[s\]. Their values then count as right, unless both are
    /// impossible ([`FOUND_BY_LIFT_AT_START`]). Source: D26.
    pub const SETTLED: f64 = 1.5;
    /// Time over which the slow means of wind and lift follow \[s\]. With more of it steady wind counts as a change for longer,
    /// with less a slow error hides. Source: D26.
    pub const MEMORY: f64 = 20.0;
    /// Error by the wind from which on the airspeed counts as wrong, as a share of it [-]: 1.4 m/s at 12 m/s.
    /// Source: D26.
    pub const FOUND_BY_WIND: f64 = 0.115;
    /// Error by the lift from which on the airspeed counts as wrong, as a share of it [-]. The estimate of the lift averages over seconds, so it shows less of an error that
    /// grows. Source: D26.
    pub const FOUND_BY_LIFT: f64 = 0.045;
    /// Error by the lift from which on the airspeed counts as wrong from the start, if the wind says so too [-]: an
    /// airframe that lifts 30 % more or less than is known. With 0.2 an airspeed that reads 3 m/s too little loses
    /// 4 points instead of 1; with 0.13 gusts and errors of the airframe look wrong twice as often. Source: D29.
    pub const FOUND_BY_LIFT_AT_START: f64 = 0.15;
    /// Time for which wind and lift must both show the error \[s\]. Gusts do so for a moment. Source: D26.
    pub const FOUND_FOR: f64 = 0.3;
    /// Mean difference of the sensor from the estimate up to which they agree, as a share of the airspeed [-].
    /// Source: chosen.
    pub const AGREES: f64 = 0.06;
    /// Time for which sensor and estimate must agree before the sensor is believed again \[s\]. Source: chosen.
    pub const AGREES_FOR: f64 = 3.0;
    /// Time over which the mean difference is taken \[s\]. Source: chosen.
    pub const OFF_TIME: f64 = 1.0;
    /// Offset of the lift coefficient up to which the motor is judged, as a share of that of level flight [-]. An
    /// airspeed that reads 1 m/s too little shows more, and makes the drag look greater than it is known.
    /// Source: D28.
    pub const MOST_LIFT: f64 = 0.18;
}

/// Airspeed and pitch that are wrong at once, told by the motion over ground.
pub mod calm_flight {
    /// Rate at which the observed velocity follows the one over ground [1/s]. With 2 the noise of positions weighs twice as much.
    /// Source: D63.
    pub const FOLLOWS: f64 = 1.0;
    /// Time after which the first estimate of the velocity is settled \[s\]. Source: D63.
    pub const SETTLED: f64 = 0.5;
    /// Time over which the differences are averaged \[s\]. Source: chosen.
    pub const MEMORY: f64 = 0.5;
    /// Time over which the difference of the airspeed is averaged \[s\]. With half a second gusts look like an error more often. Source: D63.
    pub const LONG: f64 = 10.0;
    /// Acceleration that the forces may leave unexplained, as a share of the weight [-]: three times that of noise, and half of
    /// that in gusts of 1 m/s. With 0.08 gusts on a wrong airframe look so more often. Source: D63.
    pub const UNEXPLAINED: f64 = 0.06;
    /// Least error of the airspeed, as a share of it [-]: 2.2 m/s at 12 m/s. Source: D63.
    pub const LEAST_AIRSPEED: f64 = 0.18;
    /// Least error of the pitch \[rad\]: 3.2 degrees. With 0.042 one of 80 flights with all conditions together shows it.
    /// Source: D63.
    pub const LEAST_PITCH: f64 = 0.055;
    /// Standard deviations of its difference that an error of the pitch exceeds [-]. Source: D63.
    pub const STEADY: f64 = 2.5;
    /// Time for which both sensors must be off \[s\]. Source: chosen.
    pub const FOUND_FOR: f64 = 0.4;
}

/// Effect of the elevator, seen by the turns that commands miss. Times and lengths are those of the reference aircraft; others have
/// them in their own units. Source: D55.
pub mod elevator {
    /// Time over which a turn fades from the comparison \[s\]. With 0.5 errors of the lift stay in it for longer.
    /// Source: chosen.
    pub const FADE: f64 = 0.25;
    /// Time over which turns are compared \[s\]. With 2 gusts look like a weak elevator twice as often as with 1;
    /// with less a flight shows fewer turns. Source: D27.
    pub const MEMORY: f64 = 1.0;
    /// Least covariance of the responses to command and plan from which on they are compared [rad^2]: turns by 0.8 deg.
    /// Source: chosen.
    pub const LEAST_RESPONSE: f64 = 2e-4;
    /// Greatest difference of the pitch from the expected one \[rad\]: 0.1 s of an elevator that stalls the wing.
    /// A greater difference is no turn. Source: derived.
    pub const MOST_MISSING: f64 = 0.5;
    /// Missing share of the turn from which on an elevator is weak [-]. With 0.4 gusts look so more often. Source: D27.
    pub const WEAK: f64 = 0.55;
    /// Missing share of the turn from which on an elevator does not answer [-]. The core reports such an elevator and does not correct it. Source: D27.
    pub const SILENT: f64 = 0.8;
    /// Standard deviations that a missing share exceeds [-]. With 4 gusts look like a weak elevator in eight of 400
    /// flights, with 8 a weak one is found late. Source: D27.
    pub const SIGMAS: f64 = 6.0;
    /// Missing share below which an elevator counts as proven, if its standard deviation is below [`PROVEN_ERROR`] [-].
    /// Source: chosen.
    pub const PROVEN_MISSING: f64 = 0.3;
    /// Standard deviation of the missing share below which an elevator can count as proven [-]. Source: chosen.
    pub const PROVEN_ERROR: f64 = 0.1;
    /// Time for which a proven elevator must look weak \[s\]. With less of it an elevator that sticks for a second
    /// looks weak, and is corrected when it is free again. Source: D27.
    pub const PROVEN_FOR: f64 = 0.8;
    /// Time for which an elevator that is not proven must look weak \[s\]. With 0.3 one flight of 100 with a quarter of the effect
    /// fails. Source: D27.
    pub const NEW_FOR: f64 = 0.1;
    /// Least effect that is corrected [-]. With less of it the correction is greater than 7. Source: chosen.
    pub const LEAST_EFFECT: f64 = 0.15;
}

/// The monitor of the pitch sensor, by the altitude. Its units are those of [`elevator`].
pub mod pitch_monitor {
    /// Time of each of the two high passes of altitudes \[s\]. With less the noise of positions weighs more, with more a turn is
    /// seen later. Source: chosen.
    pub const FADE: f64 = 0.5;
    /// Time over which the squares of altitudes are averaged \[s\]. With 0.6 a sensor that sticks is found 0.1 s later.
    /// Source: D41.
    pub const WINDOW: f64 = 0.3;
    /// Least altitude that a turn must give \[m\]: that of the wandering error of an RTK position. Source: derived.
    pub const LEAST_ALTITUDE: f64 = 0.05;
    /// Least turn that must give it \[rad\]: 0.4 deg. Source: D41.
    pub const LEAST_ANGLE: f64 = 0.007;
    /// Share of the altitude by the missing turn up to which the rest may go unexplained while the altitude follows the commands
    /// [-], in squares. A stuck elevator gives 1 and more. With 0.25 a sensor that sticks is found too late in 2 of 80
    /// flights. Source: D41.
    pub const FOLLOWS: f64 = 0.4;
    /// Time over which the noise of the pitch is averaged \[s\]: it halves the noise. Source: chosen.
    pub const SMOOTH: f64 = 0.05;
    /// Distance from its mean within which a pitch is still \[rad\]: four standard deviations of the averaged noise.
    /// Source: derived.
    pub const STILL: f64 = 0.008;
    /// Time for which a pitch must be still \[s\]. With less of it the start of a turn looks like a failure. Source: chosen.
    pub const STILL_FOR: f64 = 0.3;
    /// Turn that the commands must ask for while the pitch is still \[rad\]: 1.7 deg. With 0.05 a sensor that sticks is found too
    /// late in 3 of 80 flights in an empty sky. Source: D41.
    pub const MISSED: f64 = 0.03;
    /// Multiple of the usual unexpected turn that this turn must exceed [-]. With 3 gusts look like a failure in 2 of 80
    /// flights with all conditions together, without it in 15. Source: D41.
    pub const USUALS: f64 = 4.0;
    /// Time over which the usual unexpected turn is averaged \[s\]. Source: chosen.
    pub const USUAL: f64 = 10.0;
    /// First value of the usual unexpected turn \[rad\]: half of that in gusts of 1 m/s. Source: D41.
    pub const FIRST_USUAL: f64 = 0.01;
    /// Time for which altitude and pitch must contradict each other \[s\]. Source: chosen.
    pub const FAILS_FOR: f64 = 0.06;
    /// Time for which a still sensor that misses a turn waits for the altitude before the elevator is blamed \[s\]. Less of it blames
    /// the elevator for a pitch sensor, more of it reports a stuck elevator later. Source: D41.
    pub const WAIT: f64 = 1.0;
    /// Time after which the filters are settled \[s\]: twice [`FADE`]. Source: derived.
    pub const SEEN: f64 = 1.0;
}

/// The watch of the motor. Its times and the usual gain are those of the reference aircraft; they grow with the
/// cruising airspeed.
pub mod motor {
    /// Time over which a gain of speed fades from the comparison \[s\]. With less the noise of the airspeed weighs
    /// more. Source: D28.
    pub const FADE: f64 = 1.0;
    /// Rate at which the dead reckoned position follows the estimated one [1/s]. With more the noise of positions
    /// looks like a lost motor; with less a lost motor is found later. Source: chosen.
    pub const FOLLOWS: f64 = 3.0;
    /// Share of the expected gain that is missing by airspeed and wind when the motor is lost [-]. Less of it takes
    /// gusts for a lost motor, more of it finds one later. Source: D28.
    pub const BY_AIRSPEED: f64 = 0.5;
    /// Share of the expected gain that is missing by the positions when the motor is lost [-]. It is less because positions
    /// show it later. Source: D28.
    pub const BY_POSITION: f64 = 0.25;
    /// Multiple of the usual gain by airspeed that a lost thrust exceeds [-]. With 4 a gust looks like a lost motor
    /// in one of 40 flights. Source: D28.
    pub const SIGMAS: f64 = 5.0;
    /// Time over which the usual gain is averaged \[s\]. Over less a lost motor counts as usual while it is being
    /// found. Source: D28.
    pub const USUAL: f64 = 6.0;
    /// First value of the usual gain [m/s]: less than in still air, 0.1. Source: chosen.
    pub const QUIET: f64 = 0.05;
    /// Time for which both signs must show that the motor stopped or works again \[s\]. With 0.1 a gust looks like a
    /// lost motor in one of 40 flights. Source: D28.
    pub const SHOWN_FOR: f64 = 0.15;
    /// Time after which the estimates are settled \[s\]. With 2 the first estimates of the wind look like a lost
    /// motor in 3 of 200 flights with all conditions together. Source: D28.
    pub const SETTLED: f64 = 4.0;
    /// Greatest distance of the estimated position from the dead reckoned one \[m\]. It is twice that of a motor
    /// lost at full thrust; a greater distance is a jump of the position. Source: derived.
    pub const MOST_AHEAD: f64 = 1.0;
    /// Least thrust that the comparison assumes, as a share of that of level flight [-]. Less lets noise look
    /// great in a dive without thrust. Source: chosen.
    pub const LEAST_GIVEN: f64 = 0.3;
}

/// The way above the altitude band when the lidar does not show what lies beneath.
pub mod leave {
    /// Time in which nothing has returned from beneath the body axis to a lidar that is not believed \[s\]: until then the
    /// aircraft flies slowly in what the map knows, about 45 m. With 3 s `lidar-silent`, an outage of 3 s at 1 Hz, lost 10 of 200
    /// flights, 4 without the climb. Source: D59.
    pub const DARK: f64 = 4.0;
    /// Height above the band \[m\]. It also pulls: with 9 instead of 14 m, 17 instead of 8 of 100 aircraft past 40 obstacles
    /// struck what the silent half hid. Source: D59.
    pub const HEIGHT: f64 = 14.0;
    /// Distance beyond it up to which plans may go \[m\]. Source: chosen.
    pub const CEILING: f64 = 2.0;
    /// Distance by which plans may sink on the way up \[m\]; what lies beneath is not seen. Source: D59.
    pub const DIP: f64 = 1.0;
}
