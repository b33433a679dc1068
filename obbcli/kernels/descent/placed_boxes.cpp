#include "descent/placed_boxes.hpp"

namespace obb {

OBB_WIDE void place_boxes(const LaneFrame& frame, const FourNodes& nodes, BasicObb<Four>& boxes) {
    const auto lanes = [&](auto value) {
        return Four{value(*nodes[0]), value(*nodes[1]), value(*nodes[2]), value(*nodes[3])};
    };
    const auto turned = [&](const Vector3<Four>& v) {
        return Vector3<Four>{dot(frame.matrix[0], v), dot(frame.matrix[1], v),
                             dot(frame.matrix[2], v)};
    };
    const auto axes =
        axes_of_quaternion(lanes([](const Node& n) { return double{n.rotation[0]}; }),
                           lanes([](const Node& n) { return double{n.rotation[1]}; }),
                           lanes([](const Node& n) { return double{n.rotation[2]}; }),
                           lanes([](const Node& n) { return double{n.rotation[3]}; }));
    for (std::size_t k = 0; k < 3; ++k) {
        boxes.axes[k] = turned(axes[k]);
        boxes.half_extents[k] =
            frame.node_scale * lanes([k](const Node& n) { return double{n.half_extents[k]}; });
    }
    const Vector3<Four> center{frame.node_scale * lanes([](const Node& n) { return n.center.x; }),
                               frame.node_scale * lanes([](const Node& n) { return n.center.y; }),
                               frame.node_scale * lanes([](const Node& n) { return n.center.z; })};
    boxes.center = turned(center) + frame.shift;
}

} // namespace obb
