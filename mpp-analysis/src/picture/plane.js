// The charts of a flight in the vertical plane. The elevator has the unit of its aircraft's file, and its ends.
const ELEVATOR = { deg: "deg", rad: "rad" };
const CHARTS = [
  { title: "height", unit: "m", least: 1, digits: 2, limits: f => [LIMITS.altitude - band(f), LIMITS.altitude + band(f)],
    goal: LIMITS.altitude, series: [["ref_z", "reference"], ["z", "flown"]] },
  { title: "airspeed", unit: "m/s", least: 1, digits: 2, series: [["ref_airspeed", "reference"], ["airspeed", "flown"]] },
  { title: "pitch", unit: "deg", least: 4, digits: 1, change: degrees, limits: () => [-LIMITS.pitch, LIMITS.pitch],
    series: [["ref_pitch", "reference"], ["pitch", "flown"]] },
  { title: "flight path", unit: "deg", least: 4, digits: 1, change: degrees,
    limits: () => [-LIMITS.flight_path, LIMITS.flight_path], series: [["ref_flight_path", "reference"], ["flight_path", "flown"]] },
  { title: "thrust", unit: "N", least: 1, digits: 2, floor: 0, series: [["thrust", "flown"]] },
  { title: "elevator", unit: f => ELEVATOR[f.header.aircraft.elevator?.unit] || "", least: 0.1, digits: 2,
    limits: f => [f.header.aircraft.elevator?.min, f.header.aircraft.elevator?.max].filter(end => typeof end === "number"),
    series: [["elevator", "flown"]] },
  { title: "candidates (broad), feasible", unit: "", least: 2, digits: 0, floor: 0, plans: true,
    series: [["candidates", "candidate"], ["feasible", "plan"]] }];
