#include "sim/protocol/gige/genicam_description.h"

#include <cmath>
#include <initializer_list>
#include <sstream>
#include <utility>
#include <vector>

#include "sim/protocol/gige/gige_registers.h"
#include "sim/protocol/gige/pixel_packing.h"

namespace lumitexel::gige {
namespace {

struct Range {
  double min = 0, max = 0, step = 0;  // step 0: any value
};

// Collects nodes; every public feature also enters the list that a client browses.
class Description {
 public:
  Description() { text_.precision(17); }

  void integer(const std::string& name, std::uint32_t address, const char* access, Range range, int bytes = 4) {
    list(name);
    text_ << "<Integer Name=\"" << name << "\"><pValue>" << name << "Reg</pValue>";
    if (range.max > range.min) {
      text_ << "<Min>" << static_cast<std::int64_t>(range.min) << "</Min><Max>" << static_cast<std::int64_t>(range.max)
            << "</Max>";
      if (range.step > 0) text_ << "<Inc>" << static_cast<std::int64_t>(range.step) << "</Inc>";
    }
    text_ << "</Integer>\n";
    int_register(name + "Reg", address, access, bytes);
  }
  void real(const std::string& name, std::uint32_t address, const char* access, Range range, const char* unit) {
    list(name);
    text_ << "<Float Name=\"" << name << "\"><pValue>" << name << "Reg</pValue>";
    if (range.max > range.min) text_ << "<Min>" << range.min << "</Min><Max>" << range.max << "</Max>";
    if (range.step > 0) text_ << "<Inc>" << range.step << "</Inc>";
    text_ << "<Unit>" << unit << "</Unit></Float>\n";
    float_register(name + "Reg", address, access, "Device");
  }
  void text(const std::string& name, std::uint32_t address, int bytes) {
    list(name);
    text_ << "<StringReg Name=\"" << name << "\"><Address>" << address << "</Address><Length>" << bytes
          << "</Length><AccessMode>RO</AccessMode><pPort>Device</pPort></StringReg>\n";
  }
  void command(const std::string& name, std::uint32_t address, int value) {
    list(name);
    text_ << "<Command Name=\"" << name << "\"><pValue>" << name << "Reg</pValue><CommandValue>" << value
          << "</CommandValue></Command>\n";
    int_register(name + "Reg", address, "WO", 4);
  }
  void choice(const std::string& name, std::uint32_t address,
              const std::vector<std::pair<std::string, std::uint32_t>>& entries, const std::string& selects = "") {
    list(name);
    text_ << "<Enumeration Name=\"" << name << "\">";
    for (const auto& [entry, value] : entries) {
      text_ << "<EnumEntry Name=\"" << entry << "\"><Value>" << value << "</Value></EnumEntry>";
    }
    text_ << "<pValue>" << name << "Reg</pValue>";
    if (!selects.empty()) text_ << "<pSelected>" << selects << "</pSelected>";
    text_ << "</Enumeration>\n";
    int_register(name + "Reg", address, "RW", 4);
  }
  void boolean(const std::string& name, std::uint32_t address, const std::string& address_index = "") {
    list(name);
    text_ << "<Boolean Name=\"" << name << "\"><pValue>" << name
          << "Reg</pValue><OnValue>1</OnValue><OffValue>0</OffValue></Boolean>\n";
    int_register(name + "Reg", address, "RW", 4, address_index);
  }
  // What a chunk holds lies in the frame itself, at its own port.
  void chunk(const std::string& name, Chunk which, bool is_real) {
    const std::string feature = "Chunk" + name, port = feature + "Port";
    list(feature);
    text_ << "<Port Name=\"" << port << "\"><ChunkID>" << std::hex << kFirstChunkId + static_cast<std::uint32_t>(which)
          << std::dec << "</ChunkID></Port>\n";
    if (is_real) {
      float_register(feature, 0, "RO", port);
    } else {
      int_register(feature, 0, "RO", 8, "", port);
    }
  }

  std::string finished(const GigeCameraOptions& options) const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<RegisterDescription ModelName=\"" + options.model +
           "\" VendorName=\"" + options.vendor +
           "\" StandardNameSpace=\"GEV\" SchemaMajorVersion=\"1\" SchemaMinorVersion=\"1\" "
           "SchemaSubMinorVersion=\"0\" MajorVersion=\"1\" MinorVersion=\"0\" SubMinorVersion=\"0\" "
           "xmlns=\"http://www.genicam.org/GenApi/Version_1_1\">\n<Category Name=\"Root\" NameSpace=\"Standard\">" +
           listed_ + "</Category>\n" + text_.str() +
           "<Port Name=\"Device\" NameSpace=\"Standard\"></Port>\n</RegisterDescription>\n";
  }

 private:
  void list(const std::string& name) { listed_ += "<pFeature>" + name + "</pFeature>"; }
  void register_body(std::uint32_t address, const char* access, int bytes, const std::string& port) {
    text_ << "<Address>" << address << "</Address><Length>" << bytes << "</Length><AccessMode>" << access
          << "</AccessMode><pPort>" << port << "</pPort><Cachable>NoCache</Cachable>";
  }
  void int_register(const std::string& name, std::uint32_t address, const char* access, int bytes,
                    const std::string& index = "", const std::string& port = "Device") {
    text_ << "<IntReg Name=\"" << name << "\">";
    if (!index.empty()) text_ << "<pIndex Offset=\"4\">" << index << "</pIndex>";
    register_body(address, access, bytes, port);
    text_ << "<Sign>Unsigned</Sign><Endianess>BigEndian</Endianess></IntReg>\n";
  }
  void float_register(const std::string& name, std::uint32_t address, const char* access, const std::string& port) {
    text_ << "<FloatReg Name=\"" << name << "\">";
    register_body(address, access, 8, port);
    text_ << "<Endianess>BigEndian</Endianess></FloatReg>\n";
  }

  std::ostringstream text_;
  std::string listed_;
};

void describe_device(Description& xml, const GigeCameraOptions& options) {
  xml.text("DeviceVendorName", kVendorName, 32);
  xml.text("DeviceModelName", kModelName, 32);
  xml.text("DeviceVersion", kDeviceVersion, 32);
  xml.text("DeviceSerialNumber", kSerialNumber, 16);
  xml.text("DeviceUserID", kUserName, 16);
  xml.real("DeviceTemperature", kTemperature_c, "RO", {}, "C");
  xml.integer("GevHeartbeatTimeout", kHeartbeatTimeout_ms, "RW", {500, 60000, 0});
  xml.integer("GevSCPSPacketSize", kPacketSize, "RW", {576, 65532, 4});
  xml.integer("GevTimestampTickFrequency", kTimestampTickFrequency, "RO", {}, 8);
  if (options.timestamp_latch) {
    xml.command("GevTimestampControlLatch", kTimestampControl, 2);
    xml.integer("GevTimestampValue", kTimestampValue, "RO", {}, 8);
  }
}

void describe_image(Description& xml, const CameraLimits& limits) {
  const double width = limits.width_px, height = limits.height_px;
  xml.integer("SensorWidth", kSensorWidth, "RO", {});
  xml.integer("SensorHeight", kSensorHeight, "RO", {});
  xml.integer("Width", kWidth, "RW", {2, width, 2});
  xml.integer("Height", kHeight, "RW", {2, height, 2});
  xml.integer("OffsetX", kOffsetX, "RW", {0, width, 2});
  xml.integer("OffsetY", kOffsetY, "RW", {0, height, 2});
  xml.integer("PayloadSize", kPayloadSize, "RO", {});
  xml.integer("SignificantBits", kSignificantBits, "RO", {});
  std::vector<std::pair<std::string, std::uint32_t>> formats;
  for (const PixelFormat& format : pixel_formats(limits.mosaic, limits.bits)) {
    formats.emplace_back(format.name, format.code);
  }
  xml.choice("PixelFormat", kPixelFormat, formats);
}

void describe_exposure(Description& xml, const CameraLimits& limits) {
  xml.choice("AcquisitionMode", kAcquisitionMode, {{"Continuous", 0}, {"SingleFrame", 1}});
  xml.command("AcquisitionStart", kAcquisitionStart, 1);
  xml.command("AcquisitionStop", kAcquisitionStop, 1);
  xml.integer("TLParamsLocked", kParametersLocked, "RW", {0, 1, 0});
  xml.choice("TriggerSelector", kTriggerSelector, {{"FrameStart", 0}});
  xml.choice("TriggerMode", kTriggerMode, {{"Off", 0}, {"On", 1}});
  xml.choice("TriggerSource", kTriggerSource, {{"Software", 0}, {"Line0", 1}});
  xml.command("TriggerSoftware", kTriggerSoftware, 1);
  xml.real("ExposureTime", kExposureTime_us, "RW",
           {limits.exposure_min_s * 1e6, limits.exposure_max_s * 1e6, limits.exposure_step_s * 1e6}, "us");
  xml.real("Gain", kGain_db, "RW", {lowest_gain_db(limits), highest_gain_db(limits), limits.gain_step_db}, "dB");
  xml.integer("FrameName", kFrameName, "RW", {}, 8);
}

void describe_chunks(Description& xml) {
  xml.boolean("ChunkModeActive", kChunkModeActive);
  xml.choice("ChunkSelector", kChunkSelector,
             {{"ExposureTime", 0}, {"Gain", 1}, {"FrameName", 2}, {"Timestamp", 3}, {"FrameID", 4}}, "ChunkEnable");
  xml.boolean("ChunkEnable", kChunkEnable, "ChunkSelectorReg");
  xml.chunk("ExposureTime", Chunk::ExposureTime, true);
  xml.chunk("Gain", Chunk::Gain, true);
  xml.chunk("FrameName", Chunk::FrameName, false);
  xml.chunk("Timestamp", Chunk::Timestamp, false);
  xml.chunk("FrameID", Chunk::FrameId, false);
}

}  // namespace

double lowest_gain_db(const CameraLimits& limits) { return std::isfinite(limits.gain_min_db) ? limits.gain_min_db : 0; }
double highest_gain_db(const CameraLimits& limits) {
  return std::isfinite(limits.gain_max_db) ? limits.gain_max_db : 48;
}

std::string genicam_description(const CameraLimits& limits, const GigeCameraOptions& options) {
  Description xml;
  describe_device(xml, options);
  describe_image(xml, limits);
  describe_exposure(xml, limits);
  if (options.chunks) describe_chunks(xml);
  return xml.finished(options);
}

}  // namespace lumitexel::gige
