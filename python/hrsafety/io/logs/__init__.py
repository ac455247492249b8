"""Logs of robots: bags of ROS 1 and 2, trajectories of TUM and EuRoC, odometry tables."""
