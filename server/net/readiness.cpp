#include "net/readiness.hpp"

#include <spdlog/spdlog.h>

#include "polytopes/catalogue/catalogue.hpp"
#include "session/picture.hpp"

namespace oval4d::net {

void Readiness::warmUpOrMarkBroken(pipeline::Pipeline& pipeline) {
    try {
        std::vector<std::uint8_t> png;
        pipeline.warmUp();
        pipeline.drawPng(session::pictureRequestOf(session::initialState()), "", png);
        (void)polytopes::findEntry("");  // the first call builds the tables of names
        if (--missing_ == 0) spdlog::info("ready");
    } catch (const std::exception& fault) {
        broken_ = true;
        spdlog::error("frames cannot be drawn fault=\"{}\"", fault.what());
    }
}

}  // namespace oval4d::net
