//! The companion's command line.

fn main() {
    let mut args = std::env::args().skip(1);
    let flights = args.next().and_then(|n| n.parse().ok()).unwrap_or(20);
    match mpp_companion::stand_in::figures(flights, 77_000) {
        Ok(text) => println!("{text}"),
        Err(error) => println!("{error}"),
    }
}
