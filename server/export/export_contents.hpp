#pragma once

#include <array>
#include <cstdint>

#include "text/choice.hpp"

namespace oval4d::exports {

/// What a file contains. protocol/export_formats.json says which of these the files of a format can contain.
enum class ExportContentsKind : std::uint8_t {
    focus,        ///< only the focus slice
    oval,         ///< all slices
    highlight,    ///< the highlighted element alone
    critical,     ///< the critical values of w: see slicing::findCriticalSections()
    object,       ///< the whole rotated object, in four dimensions
    coordinates,  ///< the parallel coordinates or, for a field, the histogram
    projection,   ///< the projection of the whole object
    matrix        ///< the matrix of planar sections
};

inline constexpr auto kExportContents =
    text::completeTable<text::NamedValue<ExportContentsKind>>({{"focus", ExportContentsKind::focus},
                                                               {"oval", ExportContentsKind::oval},
                                                               {"highlight", ExportContentsKind::highlight},
                                                               {"critical", ExportContentsKind::critical},
                                                               {"object", ExportContentsKind::object},
                                                               {"coordinates", ExportContentsKind::coordinates},
                                                               {"projection", ExportContentsKind::projection},
                                                               {"matrix", ExportContentsKind::matrix}});
constexpr const auto& choicesOf(ExportContentsKind /*type*/) { return kExportContents; }

}  // namespace oval4d::exports
