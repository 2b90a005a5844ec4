"""MAVProxy, driven as from a keyboard; what happened is read from its own log."""

import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

TOOLS = Path(sys.executable).parent


def tool(name):
    path = TOOLS / name
    return str(path) if path.exists() else shutil.which(name)


@pytest.mark.skipif(tool("mavproxy.py") is None, reason="MAVProxy is not installed")
def test_mavproxy_reads_tunes_arms_and_records(simulate, tmp_path):
    simulation = simulate("--hold", "--speed", "1", "--duration", "60")
    log = tmp_path / "mav.tlog"
    command = [
        sys.executable, tool("mavproxy.py"), f"--master=udp:127.0.0.1:{simulation.port}", f"--logfile={log}",
        f"--state-basedir={tmp_path}", "--default-modules=log,link,arm,mode,param,misc,cmdlong,wp",
    ]
    # It keeps its settings there.
    environment = {"HOME": str(tmp_path), "PATH": str(TOOLS) + ":/usr/bin:/bin"}
    proxy = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment,
        cwd=tmp_path,
    )
    try:
        # Parameters come before they can be set.
        for pause, line in [
            (7, "param set MPP_PATHS 12"), (1, "param set MPP_PATHS 99"), (2, "arm throttle"), (1, "long 511 30 20000"),
            (1, "long 31999 1"), (1, "wp list"), (1, "mode CRUISE"), (4, "param save saved.parm"), (2, ""),
        ]:
            time.sleep(pause)
            proxy.stdin.write(line + "\n")
            proxy.stdin.flush()
        proxy.stdin.close()
        proxy.wait(timeout=20)
        said = proxy.stdout.read()
    finally:
        if proxy.poll() is None:
            proxy.kill()
    assert "Received 34 parameters" in said, said

    def dump(kind):
        command = [sys.executable, tool("mavlogdump.py"), "--types", kind, str(log)]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout

    paths = [line for line in dump("PARAM_VALUE").splitlines() if "MPP_PATHS" in line]
    assert "param_value : 25.0" in paths[0] and "param_value : 12.0" in paths[-1], paths
    acks = dump("COMMAND_ACK")
    for command, result in [(400, 0), (511, 0), (31_999, 3), (176, 0)]:
        assert f"command : {command}, result : {result}" in acks, acks
    assert "count : 0" in dump("MISSION_COUNT")
    heartbeats = dump("HEARTBEAT").splitlines()
    assert any("custom_mode : 7" in line for line in heartbeats)
