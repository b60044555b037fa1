#include "net/jobs/file_reader.hpp"

#include <utility>

namespace oval4d::net {

session::FileReader makeFileReader(const Services& services, std::stop_token stop) {
    return [&readers = services.readers, &data = services.data, workersStop = services.loadWorkers.stopToken(),
            stop = std::move(stop)](const session::LoadObject& load, const session::Limits& limits) {
        std::stop_source either;
        const auto requestStop = [&either] { either.request_stop(); };
        const std::stop_callback whenWorkersStop(workersStop, requestStop);
        const std::stop_callback whenStopped(stop, requestStop);
        if (load.dataName.empty()) return readers.read(load, limits, either.get_token());
        return data.read(load, limits,
                         [&](const session::LoadObject& file, const session::Limits& most,
                             const file_reading::FileAllocator& allocate) {
                             return readers.read(file, most, either.get_token(), allocate);
                         });
    };
}

}  // namespace oval4d::net
