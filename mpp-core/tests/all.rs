//! Integration tests of the flight core, in one binary: each of several would be linked alone.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

mod clock;
mod closed_loop;
mod common;
mod corridor_segments;
mod dead_time;
mod distance_field;
mod disturbances;
mod elevator_effect;
mod errors;
mod estimator;
mod flight;
mod flight_programs;
mod gate;
mod late_air_data;
mod lattice;
mod lift;
mod map;
mod motor_watch;
mod navigation;
mod own_units;
mod paths;
mod planner;
mod planner_anytime;
mod planner_blind;
mod planner_composition;
mod planner_flight;
mod planner_limits;
mod planner_setup;
mod planner_space;
mod planner_space_offers;
mod point_mass;
mod qp;
mod rays;
mod regulator;
mod resampling;
mod rolling_grid;
mod scan_monitor;
mod settings_at_random;
mod space_estimate;
mod space_least_squares;
mod thrust_lag;
mod trajectory;
mod vehicle;
mod watches;
