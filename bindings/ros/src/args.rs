//! The command line, as ROS 2 programs take it: `--ros-args -r from:=to -p name:=value`.

/// What a command line asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Args {
    /// Name of the node.
    pub(crate) node: String,
    /// Namespace of the node, `/` or without a slash at its end.
    pub(crate) namespace: String,
    remaps: Vec<(String, String)>,
    /// Parameters and their values, the last one of a name last.
    pub(crate) parameters: Vec<(String, String)>,
}

/// What a command line is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Asked {
    /// The node has to run.
    Run(Args),
    /// The help.
    Help,
    /// The version.
    Version,
}

/// Why a command line makes no sense.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum ArgsError {
    /// An argument that is none of ours.
    #[error("unknown argument `{0}`: give --ros-args -r from:=to -p name:=value, or --help")]
    Unknown(String),
    /// A flag without its value.
    #[error("`{0}` lacks its value: give {1}")]
    Lacks(String, &'static str),
    /// A rule without `:=`.
    #[error("`{0}`: give {1}")]
    Rule(String, &'static str),
    /// No name of ROS.
    #[error("`{0}` is no name of ROS: give letters, digits and single underscores, parted by /")]
    Name(String),
}

const REMAP: &str = "from:=to";
const PARAMETER: &str = "name:=value";

impl Args {
    /// Reads the arguments after the program's name.
    ///
    /// # Errors
    /// The first argument that makes no sense.
    pub(crate) fn parse(all: impl IntoIterator<Item = String>) -> Result<Asked, ArgsError> {
        let mut args = Self {
            node: "mpp".to_owned(),
            namespace: "/".to_owned(),
            remaps: Vec::new(),
            parameters: Vec::new(),
        };
        let (mut all, mut ros) = (all.into_iter(), false);
        while let Some(flag) = all.next() {
            let mut rule = |form| {
                let text = all.next().ok_or(ArgsError::Lacks(flag.clone(), form))?;
                let parts = text.split_once(":=").filter(|(name, _)| !name.is_empty());
                let parts = parts.map(|(name, value)| (name.to_owned(), value.to_owned()));
                parts.ok_or(ArgsError::Rule(text, form))
            };
            match (ros, flag.as_str()) {
                (_, "-h" | "--help") => return Ok(Asked::Help),
                (_, "-V" | "--version") => return Ok(Asked::Version),
                (_, "--ros-args") => ros = true,
                (true, "--") => ros = false,
                (true, "-r" | "--remap") => args.remap(rule(REMAP)?)?,
                (true, "-p" | "--param") => args.parameters.push(rule(PARAMETER)?),
                // It says nothing of a level.
                (true, "--log-level") => drop(all.next()),
                _ => return Err(ArgsError::Unknown(flag)),
            }
        }
        Ok(Asked::Run(args))
    }

    fn remap(&mut self, (from, to): (String, String)) -> Result<(), ArgsError> {
        match from.as_str() {
            "__node" | "__name" => {
                self.node = to.clone();
                checked(to, false)?;
            }
            "__ns" => {
                let bare = to.trim_end_matches('/');
                self.namespace = if bare.is_empty() { "/" } else { bare }.to_owned();
                if !to.starts_with('/') {
                    return Err(ArgsError::Rule(to, "a namespace that begins with /"));
                }
                if self.namespace != "/" {
                    checked(to.trim_end_matches('/').to_owned(), true)?;
                }
            }
            _ => {
                for name in [&from, &to] {
                    let name = name.strip_prefix("~/").unwrap_or(name);
                    checked(name.to_owned(), true)?;
                }
                self.remaps.push((from, to));
            }
        }
        Ok(())
    }

    /// The whole name of a topic, after the first rule that speaks of it.
    pub(crate) fn topic(&self, name: &str) -> String {
        let whole = self.whole(name);
        let of_it = |(from, _): &&(String, String)| self.whole(from) == whole;
        let rule = self.remaps.iter().find(of_it);
        rule.map_or(whole.clone(), |(_, to)| self.whole(to))
    }

    fn whole(&self, name: &str) -> String {
        let within = self.namespace.trim_end_matches('/');
        if name.starts_with('/') {
            name.to_owned()
        } else if let Some(own) = name.strip_prefix("~/") {
            format!("{within}/{}/{own}", self.node)
        } else {
            format!("{within}/{name}")
        }
    }
}

/// A name that ROS takes.
fn checked(name: String, parts: bool) -> Result<(), ArgsError> {
    let is_token = |token: &str| {
        token.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_')
            && token.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            && !token.contains("__")
    };
    let bare = if parts {
        name.strip_prefix('/').unwrap_or(&name)
    } else {
        &name
    };
    let is_name = if parts {
        bare.split('/').all(is_token)
    } else {
        is_token(bare)
    };
    is_name.then_some(()).ok_or(ArgsError::Name(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Asked, ArgsError> {
        Args::parse(text.split_whitespace().map(str::to_owned))
    }

    fn args(text: &str) -> Args {
        match parse(text).unwrap() {
            Asked::Run(args) => args,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn topics_are_remapped_as_ros_does() {
        let none = args("");
        assert_eq!(none.topic("scan"), "/scan");
        let ours = args(
            "--ros-args -r scan:=/front/scan --remap /uav/goal:=far -r __ns:=/uav -r __node:=own \
             -r ~/x:=y -r odometry:=~/pose",
        );
        assert_eq!(
            (ours.node.as_str(), ours.namespace.as_str()),
            ("own", "/uav")
        );
        assert_eq!(ours.topic("scan"), "/front/scan");
        assert_eq!(ours.topic("goal"), "/uav/far");
        assert_eq!(ours.topic("plan"), "/uav/plan");
        assert_eq!(ours.topic("~/x"), "/uav/y");
        assert_eq!(ours.topic("odometry"), "/uav/own/pose");
    }

    #[test]
    fn parameters_are_kept_in_order() {
        let ours = args("--ros-args -p a:=1 --param b:=x:=y --log-level debug -- --ros-args");
        let pairs = ours
            .parameters
            .iter()
            .map(|(a, b)| (a.as_str(), b.as_str()));
        assert!(pairs.eq([("a", "1"), ("b", "x:=y")]));
    }

    #[test]
    fn what_makes_no_sense_is_refused() {
        for wrong in [
            "-p a:=1",
            "fly",
            "--ros-args -p",
            "--ros-args -p a=1",
            "--ros-args -p :=1",
            "--ros-args --params-file x.yaml",
            "--ros-args -r __ns:=uav",
            "--ros-args -r __node:=a/b",
            "--ros-args -r scan:=a//b",
            "--ros-args -r scan:=2d",
            "--ros-args -r mpp:scan:=other",
            "--ros-args -- -p a:=1",
        ] {
            assert!(parse(wrong).is_err(), "{wrong}");
        }
        assert_eq!(parse("--ros-args --help"), Ok(Asked::Help));
        assert_eq!(parse("--version"), Ok(Asked::Version));
    }
}
