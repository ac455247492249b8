"""The robot that follows a sound, with a camera that tells of the obstacles in place of its sonar."""

from __future__ import annotations

from hrsafety import navigation as nav
from hrsafety import reactive

box = reactive.MovingObstacle(shape=reactive.Box(center=(2.5, 1.5), size=(0.5, 0.5)), velocity=(0.0, -0.3), stop=10.0)
leader = reactive.SoundLeader(start=(1.2, 0.0), end=(6.0, 0.0))
scene = reactive.FollowerScene(leader=leader, obstacles=[box])
for name, camera in {"sonar": None, "camera": nav.sensing.Vision()}.items():
    run = reactive.follow(scene, follower=reactive.Follower(obstacle_vision=camera))
    print(f"{name:6} collided: {run.collided}, least clearance {run.min_clearance:.2f} m")
