//! The module of flights in space.

#![cfg(target_arch = "wasm32")]

use mpp_web::space::Desk;

mod door;
