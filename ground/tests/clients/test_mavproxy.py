"""Drives MAVProxy as from a keyboard. MAVProxy's own log shows what happened."""

import re
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from simulation import LASTING, LIMIT, parameters, until

TOOLS = Path(sys.executable).parent


def tool(name):
    path = TOOLS / name
    return str(path) if path.exists() else shutil.which(name)


class Proxy:
    """A running MAVProxy. It takes lines, and its output is kept."""

    def __init__(self, port, directory):
        self.log = directory / "mav.tlog"
        command = [
            sys.executable, "-u", tool("mavproxy.py"), f"--master=udp:127.0.0.1:{port}", f"--logfile={self.log}",
            f"--state-basedir={directory}", "--default-modules=log,link,arm,mode,param,misc,cmdlong,wp,fence,ftp",
        ]
        # MAVProxy keeps its settings there.
        environment = {"HOME": str(directory), "PATH": str(TOOLS) + ":/usr/bin:/bin"}
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            env=environment, cwd=directory,
        )
        self.said = ""
        self.typed = 0
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()

    def read(self):
        while text := self.process.stdout.readline():
            self.said += text

    def hears(self, text):
        """Waits until MAVProxy has printed this text since the last line was typed."""
        until(lambda: text in self.said[self.typed:], f"MAVProxy to say {text!r}")

    def type(self, line):
        self.typed = len(self.said)
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def end(self):
        self.process.stdin.close()
        self.process.wait(timeout=LIMIT)
        self.reader.join(timeout=LIMIT)

    def logged(self, kind):
        command = [sys.executable, tool("mavlogdump.py"), "--types", kind, str(self.log)]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout


@pytest.fixture
def proxy(simulate, tmp_path):
    simulation = simulate(*LASTING)
    proxy = Proxy(simulation.port, tmp_path)
    yield proxy
    if proxy.process.poll() is None:
        proxy.process.kill()
        proxy.process.wait()


@pytest.mark.skipif(tool("mavproxy.py") is None, reason="MAVProxy is not installed")
def test_mavproxy_counts_no_loss_on_a_healthy_link(simulate, tmp_path):
    """It does not know the private messages, and counts each of them as lost."""
    simulation = simulate("--speed", "1", "--duration", "3600", "--obstacles", "0", "--replan-hz", "4")
    proxy = Proxy(simulation.port, tmp_path)
    try:
        def counted():
            proxy.type("link")
            time.sleep(1.0)
            told = re.findall(r"(\d+) packets, .*?(\d+) lost", proxy.said)
            return told and int(told[-1][0]) > 500 and told[-1]

        packets, lost = map(int, until(counted, "500 packets"))
        # A datagram may be lost on a slow machine.
        assert lost < 0.02 * packets, proxy.said
    finally:
        proxy.process.kill()
        proxy.process.wait()


@pytest.mark.skipif(tool("mavproxy.py") is None, reason="MAVProxy is not installed")
def test_mavproxy_reads_tunes_arms_and_records(proxy):
    proxy.hears(f"Received {len(parameters())} parameters")
    proxy.type("set flushlogs True")
    proxy.type("param set MPP_PATHS 12")

    def is_set():
        proxy.type("param show MPP_PATHS")
        time.sleep(0.5)
        return re.search(r"MPP_PATHS +12\.0", proxy.said)

    until(is_set, "MPP_PATHS to be 12")
    proxy.type("param set MPP_PATHS 99")
    proxy.hears("MPP_PATHS: out of range")
    proxy.type("arm throttle")
    proxy.hears("Got COMMAND_ACK: COMPONENT_ARM_DISARM: ACCEPTED")
    proxy.hears("ARMED")
    proxy.type("long 511 30 20000")
    proxy.hears("Got COMMAND_ACK: SET_MESSAGE_INTERVAL: ACCEPTED")
    proxy.type("long 31999 1")
    proxy.hears("command : 31999, result : 3")
    proxy.type("ftp list /")
    proxy.hears("parameter.json")
    proxy.type("wp list")
    proxy.hears("Requesting 0 waypoints")
    proxy.type("mode CRUISE")
    proxy.hears("Mode CRUISE")
    proxy.hears("CRUISE: it does not look for obstacles")
    proxy.type("param save saved.parm")
    proxy.hears(f"Saved {len(parameters())} parameters to saved.parm")
    # Output that MAVProxy has not written when it ends is lost.
    until(lambda: proxy.logged("HEARTBEAT").count("custom_mode : 7") > 2, "CRUISE in MAVProxy's log")
    # No scan is due, so that none is missing.
    assert "Sensor lidar failed" not in proxy.said
    proxy.end()

    paths = [line for line in proxy.logged("PARAM_VALUE").splitlines() if "MPP_PATHS" in line]
    assert "param_value : 25.0" in paths[0] and "param_value : 12.0" in paths[-1], paths
    acks = proxy.logged("COMMAND_ACK")
    for command, result in [(400, 0), (511, 0), (31_999, 3), (176, 0)]:
        assert f"command : {command}, result : {result}" in acks, acks
    assert "count : 0" in proxy.logged("MISSION_COUNT")
    assert "breach" not in proxy.said
    # It asked for its parameters as a file first, and went on at once.
    assert "FILE_TRANSFER_PROTOCOL" in proxy.logged("FILE_TRANSFER_PROTOCOL")
