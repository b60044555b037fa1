#include "export/formats/writers.hpp"

namespace oval4d::exports {

std::string off(const SceneToWrite& source) {
    return slicing::write4Off(source.object, source.scene.slices->rotatedVertices);
}

}  // namespace oval4d::exports
