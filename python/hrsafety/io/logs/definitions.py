"""Definitions of messages that bags may hold without their definitions, and that come with no distribution of ROS."""

from __future__ import annotations

__all__ = ["DEFINITIONS"]

DEFINITIONS: dict[str, dict[str, str]] = {
    "people_msgs/msg/People": {
        "people_msgs/msg/People": "std_msgs/Header header\npeople_msgs/Person[] people\n",
        "people_msgs/msg/Person": """string name
geometry_msgs/Point position
geometry_msgs/Point velocity
float64 reliability
string[] tagnames
string[] tags
""",
    },
    "hunav_msgs/msg/Agents": {
        "hunav_msgs/msg/Agents": "std_msgs/Header header\nhunav_msgs/Agent[] agents\n",
        "hunav_msgs/msg/Agent": """int32 id
uint8 type
uint8 skin
uint8 behavior
string name
uint8 behavior_state
int8 group_id
geometry_msgs/Pose position
float32 yaw
geometry_msgs/Twist velocity
float32 desired_velocity
float32 radius
float32 linear_vel
float32 angular_vel
geometry_msgs/Pose[] goals
bool cyclic_goals
float32 goal_radius
geometry_msgs/Point[] closest_obs
""",
    },
    "tf2_msgs/msg/TFMessage": {"tf2_msgs/msg/TFMessage": "geometry_msgs/TransformStamped[] transforms\n"},
}
"""Texts of a type and of those that it is made of, as their packages have them."""
