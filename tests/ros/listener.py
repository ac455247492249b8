"""A node of its own that drives a bridge in real time and writes down what it heard; run by the Python of ROS 2."""

from __future__ import annotations

import json
import sys
import time

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import LaserScan
from visualization_msgs.msg import MarkerArray

BEST = ReliabilityPolicy.BEST_EFFORT
TOPICS = {
    "/clock": (Clock, QoSProfile(depth=10, reliability=BEST)),
    "/odom": (Odometry, QoSProfile(depth=50)),
    "/scan": (LaserScan, QoSProfile(depth=10, reliability=BEST)),
    "/people_markers": (MarkerArray, QoSProfile(depth=10)),
    "/hrsafety/verdict": (DiagnosticArray, QoSProfile(depth=10)),
    "/map": (OccupancyGrid, QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)),
}


def main(seconds: float, stamped: bool) -> None:
    """Listen and drive for a time, and print counts, qualities and what the last messages said."""
    rclpy.init()
    node = rclpy.create_node("listener")
    heard = {topic: [] for topic in TOPICS}
    for topic, (kind, quality) in TOPICS.items():
        node.create_subscription(kind, topic, heard[topic].append, quality)
    commands = node.create_publisher(TwistStamped if stamped else Twist, "cmd_vel", 10)

    def drive() -> None:
        twist = Twist()
        twist.linear.x = 0.4
        if not stamped:
            commands.publish(twist)
        elif heard["/odom"]:
            message = TwistStamped(twist=twist)
            message.header.stamp = heard["/odom"][-1].header.stamp
            commands.publish(message)

    node.create_timer(0.05, drive)
    until = time.monotonic() + 30.0
    while not heard["/odom"] and time.monotonic() < until:
        rclpy.spin_once(node, timeout_sec=0.1)
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        rclpy.spin_once(node, timeout_sec=0.1)
    qualities = {}
    for topic in TOPICS:
        (info,) = node.get_publishers_info_by_topic(topic)
        quality = info.qos_profile
        qualities[topic] = [
            quality.reliability != BEST,
            quality.durability == DurabilityPolicy.TRANSIENT_LOCAL,
            info.topic_type,
        ]
    scan, grid = heard["/scan"][-1], heard["/map"][-1]
    print(
        json.dumps(
            {
                "counts": {topic: len(messages) for topic, messages in heard.items()},
                "qualities": qualities,
                "speed": heard["/odom"][-1].twist.twist.linear.x,
                "beams": len(scan.ranges),
                "nothing": sum(each == float("inf") for each in scan.ranges),
                "cells": len(grid.data) == grid.info.width * grid.info.height,
                "occupied": sum(each == 100 for each in grid.data),
                "people": len(heard["/people_markers"][-1].markers),
                "level": heard["/hrsafety/verdict"][-1].status[0].level.hex(),
            }
        )
    )


if __name__ == "__main__":
    main(float(sys.argv[1]), sys.argv[2] == "stamped")
