// What a buffer of the library holds, checked and as our Frame. Only for the .cpp files of this folder.
#pragma once

#include <string>

#include "drivers/aravis/aravis_handle.h"
#include "drivers/aravis/genicam_settings.h"
#include "drivers/camera.h"

namespace lumitexel {

// Samples, ids, times and what the chunks say; reported settings are NaN where there is no chunk of them: the caller
// fills them in. camera: its name, for messages. chunks: the camera's parser; may be null if it sends no chunks.
// Throws Protocol for another size, format or amount of data than was set up, for a chunk that cannot be read, and for a
// sample beyond the rig's bits.
Frame received_frame(ArvBuffer* buffer, ArvChunkParser* chunks, const CameraSetup& setup, const CameraLimits& limits,
                     const std::string& frame_name_chunk, const std::string& camera);

}  // namespace lumitexel
