"""Scenes of other simulators of people."""

from __future__ import annotations

from os import PathLike

from hrsafety.io.places.crowdnav import CrowdNavScene, is_crowdnav, read_crowdnav
from hrsafety.io.places.hunav import HuNavScene, is_hunav, read_hunav
from hrsafety.io.reader import Document, Reader, reader_of

__all__ = ["READERS", "load_scene"]


def load_scene(path: str | PathLike[str], *, format: str | None = None) -> HuNavScene | CrowdNavScene:
    """Return the scene of another simulator; its ``world()`` is one of this package.

    Worlds of BARN are maps: `load_map`.

    Parameters
    ----------
    path : path
        Agents of HuNavSim (YAML) or an environment of CrowdNav (INI).
    format : {"hunavsim", "crowdnav"} or None
        Its format, if contents are not to decide.

    Returns
    -------
    HuNavScene or CrowdNavScene
        What the file says, with warnings about what is not simulated.

    Raises
    ------
    InvalidParameterError
        If there is no such file.
    FileError
        If it is of no known format or breaks a rule; the error names file, line and key.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import io
    >>> text = '''
    ... hunav_loader:
    ...   ros__parameters:
    ...     map: hall
    ...     agents: [agent1]
    ...     agent1: {id: 1, behavior: 1, group_id: -1, max_vel: 1.2, radius: 0.3, goal_radius: 0.3, cyclic_goals: true,
    ...       init_pose: {x: 0.0, y: 1.0, h: 0.0}, goals: [g0], g0: {x: 5.0, y: 1.0, h: 0.0}}
    ... '''
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "agents.yaml")
    ...     _ = path.write_text(text)
    ...     scene = io.load_scene(path)
    >>> scene.map, scene.people[0].route, scene.world(time_limit=10.0).people[0].at_end
    ('hall', ((5.0, 1.0),), 'repeat')
    """
    document = Document(path)
    found: HuNavScene | CrowdNavScene = reader_of("scene", document, format).read(document)
    return found


READERS = [
    Reader(name="hunavsim", title="agents of HuNavSim", recognizes=is_hunav, read=read_hunav),
    Reader(name="crowdnav", title="environment of CrowdNav", recognizes=is_crowdnav, read=read_crowdnav),
]
