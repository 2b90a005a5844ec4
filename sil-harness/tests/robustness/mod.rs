//! What goes wrong around a flight: full disks, foreign files, signals, strangers on a socket.

mod files;
#[cfg(unix)]
mod keys;
mod killed;
mod live;
mod mutated;
mod orders;
#[cfg(target_os = "linux")]
mod signals;
