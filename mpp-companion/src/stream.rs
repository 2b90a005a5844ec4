//! Ways that end when the other side goes, and are opened anew.

use crate::port::Port;
use std::io::{Error, ErrorKind, Read, Result, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Both directions of a stream.
pub(crate) type Ends = (Box<dyn Read + Send>, Box<dyn Write + Send>);

/// How often a stream is opened anew before the companion ends, and the pause before each try.
pub(crate) type Tries = (u32, Duration);
/// A minute.
pub(crate) const USUAL: Tries = (60, Duration::from_secs(1));

/// A way by a stream that is opened now, and again whenever it ends. Meanwhile nothing comes, and what is sent is lost.
///
/// # Errors
/// When the stream cannot be opened now.
pub(crate) fn lasting(at: &str, tries: Tries, open: fn(&str) -> Result<Ends>) -> Result<Port> {
    let (mut read, write) = open(at)?;
    let at = at.to_owned();
    let end = Arc::new(Mutex::new(Some(write)));
    let own = Arc::clone(&end);
    let set = move |write| *own.lock().unwrap_or_else(PoisonError::into_inner) = write;
    Ok(Port {
        read: Box::new(move |buffer| {
            match read.read(buffer) {
                Ok(size) if size > 0 => return Ok(size),
                Err(error) if error.kind() == ErrorKind::Interrupted => return Ok(0),
                _ => set(None),
            }
            println!("{at} has ended");
            let (again, write) = reopen(&at, tries, open)?;
            read = again;
            set(Some(write));
            println!("{at} is open again");
            Ok(0)
        }),
        write: Box::new(move |frame| {
            let mut end = end.lock().unwrap_or_else(PoisonError::into_inner);
            end.as_mut().map_or(Ok(()), |end| end.write_all(frame))
        }),
    })
}

fn reopen(at: &str, (most, pause): Tries, open: fn(&str) -> Result<Ends>) -> Result<Ends> {
    let mut number = 0;
    loop {
        std::thread::sleep(pause);
        number += 1;
        match open(at) {
            Err(error) if number < most => println!("{at}, try {number} of {most}: {error}"),
            ends => return ends,
        }
    }
}

/// A TCP connection. One over which nothing comes for 5 s has ended: an autopilot sends a heartbeat each second.
pub(crate) fn tcp(peer: &str) -> Result<Ends> {
    let address = peer.to_socket_addrs()?.next();
    let address = address.ok_or(ErrorKind::AddrNotAvailable)?;
    let stream = TcpStream::connect_timeout(&address, Duration::from_secs(3))?;
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(Duration::from_secs(5)))?;
    // A peer that takes nothing must not hold up the companion.
    stream.set_write_timeout(Some(Duration::from_millis(20)))?;
    Ok((Box::new(stream.try_clone()?), Box::new(stream)))
}

/// A serial port, DEVICE:BAUD, that passes each byte as it is: 8 bits, no parity, no control of the flow.
#[cfg(unix)]
pub(crate) fn serial(line: &str) -> Result<Ends> {
    use rustix::fs::{Mode, OFlags, fcntl_setfl, open};
    use rustix::termios::{ControlModes, OptionalActions, tcgetattr, tcsetattr};
    let wrong = |text: String| Error::new(ErrorKind::InvalidInput, text);
    let advise = |error| {
        wrong(format!(
            "{error}: find its name in /dev/serial/by-id, and join the group dialout"
        ))
    };
    let parts = line.rsplit_once(':');
    let parts = parts.and_then(|(device, baud)| Some((device, baud.parse::<u32>().ok()?)));
    let (device, baud) = parts
        .filter(|(_, baud)| (1200..=4_000_000).contains(baud))
        .ok_or_else(|| wrong("give serial:DEVICE:BAUD with 1200 to 4000000 baud".into()))?;
    // A port with the lines of a modem would wait for its carrier.
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC | OFlags::NONBLOCK;
    let port = open(device, flags, Mode::empty()).map_err(advise)?;
    let mut line = tcgetattr(&port).map_err(advise)?;
    line.make_raw();
    line.control_modes |= ControlModes::CLOCAL | ControlModes::CREAD;
    line.control_modes -= ControlModes::CRTSCTS | ControlModes::CSTOPB;
    line.set_speed(baud)?;
    tcsetattr(&port, OptionalActions::Now, &line)?;
    let given = tcgetattr(&port)?.output_speed();
    // A receiver bears 3 %.
    if given.abs_diff(baud) > baud / 33 {
        let text = format!("the port makes {given} of {baud} baud: give a speed that it has");
        return Err(wrong(text));
    }
    fcntl_setfl(&port, OFlags::RDWR)?;
    let port = std::fs::File::from(port);
    Ok((Box::new(port.try_clone()?), Box::new(port)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    const BRIEF: Tries = (3, Duration::from_millis(1));

    /// ArduPlane's simulation waits for a client.
    #[test]
    fn a_connection_that_ended_is_opened_again_and_tries_are_bounded() {
        let waits = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = format!("tcp:{}", waits.local_addr().unwrap());
        let mut port = Port::open(&address, BRIEF).unwrap();
        let mut buffer = [0; 8];
        for _ in 0..2 {
            let (mut peer, _) = waits.accept().unwrap();
            peer.write_all(b"beat").unwrap();
            assert_eq!((port.read)(&mut buffer).unwrap(), 4);
            (port.write)(b"set").unwrap();
            assert_eq!(peer.read(&mut buffer).unwrap(), 3);
            drop(peer);
            assert_eq!((port.read)(&mut buffer).unwrap(), 0);
        }
        drop(waits);
        assert!((port.read)(&mut buffer).is_err());
        assert!((port.write)(b"lost").is_ok());
    }

    /// A pseudo terminal is a serial port whose other end a program holds.
    #[cfg(unix)]
    #[test]
    fn a_serial_port_passes_each_byte_as_it_is_and_its_loss_is_bounded_too() {
        use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
        let end = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&end).unwrap();
        unlockpt(&end).unwrap();
        let name = ptsname(&end, Vec::new()).unwrap();
        let address = format!("serial:{}:57600", name.to_str().unwrap());
        let mut port = Port::open(&address, BRIEF).unwrap();
        let mut autopilot = std::fs::File::from(end);
        let all: [u8; 256] = std::array::from_fn(|byte| byte as u8);
        autopilot.write_all(&all).unwrap();
        let (mut passed, mut size) = ([0; 256], 0);
        while size < all.len() {
            size += (port.read)(&mut passed[size..]).unwrap();
        }
        assert_eq!(passed, all);
        (port.write)(&all).unwrap();
        autopilot.read_exact(&mut passed).unwrap();
        assert_eq!(passed, all);
        drop(autopilot);
        assert!((port.read)(&mut passed).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn a_bad_speed_and_a_device_that_is_not_there_are_refused_with_advice() {
        let (name, form) = ("/dev/serial/by-id", "serial:DEVICE:BAUD");
        for line in ["none:57600", "null:57600", "none:57k", "none:0", "none"] {
            let advice = if line.ends_with("600") { name } else { form };
            let refused = Port::open(&format!("serial:/dev/{line}"), BRIEF).err();
            let refused = refused.unwrap().to_string();
            assert!(refused.contains(advice), "{refused}");
        }
    }
}
