//! The version of the link. Every other module may import this module; it imports no other module.

/// The version of the link in this crate. The crate's documentation has the table of versions, and the
/// rule for a new number.
pub const PROTOCOL_VERSION: u8 = 2;
