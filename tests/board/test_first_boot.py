"""A board that is switched on for the first time, with a camera by V4L2."""
from case import BoardTest
from tracking import Tracking


class OnV4l2(Tracking, BoardTest):
    camera = "v4l2:/dev/video0"
