#include "net/file_job.hpp"

#include <utility>

namespace oval4d::net {

std::function<MadeFile(picture::Painter&)> fileJob(Services services, const session::State& state,
                                                   const exports::Wish& wish) {
    return [services, state, wish](picture::Painter& /*unused*/) -> MadeFile {
        auto made = picture::fileOf(state, wish, services.options.file, services.files.stopToken());
        if (!made) return protocol::Result<Bytes>(made.error());
        return protocol::Result<Bytes>(Bytes(std::move(*made)));
    };
}

}  // namespace oval4d::net
