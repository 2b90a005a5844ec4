//! Tests properties of the program's solver: optimality, invariances, ends.

mod brute_force;
mod certificates;
mod conditions;
mod degenerate;
mod dense;
mod ends;
mod invariances;
mod optimality;
mod programs;
mod small_programs;
mod symmetries;
mod varying;
