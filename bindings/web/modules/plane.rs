//! The module of flights in the vertical plane.

#![cfg(target_arch = "wasm32")]

use mpp_web::desk::Desk;

mod door;
