#pragma once
/// Every option of the odometry, one flat struct per stage, with unit and range. Pixels are those of a camera
/// with f = 525 px and 640 columns, frames those of 30 Hz: other cameras and rates scale them. The same table
/// serves config files,
/// `--set`, config_used.ini, --help and the checks.

#include <cmath>
#include <string>
#include <variant>
#include <vector>

namespace roevo {

inline constexpr double kFrameRate = 30;  ///< Hz, that counts of frames are meant for

enum class Mode { kCoarse, kTracking, kBundleAdjustment };  ///< paper's ct, tr and tr+ba

struct SensorOptions {
    double depth_weight_k = 0.6;      ///< k of Eq. (20), 1/m
    double min_depth = 0.2;           ///< d_min of Eq. (20), m; nearer depths are not used
    double max_depth = 5.0;           ///< d_max of Eq. (20), m
    double depth_limit = 9.0;         ///< farther depths are not used, m
    double depth_noise = 2e-3;        ///< a in sigma_z^2 = s0^2 + (a z^2)^2, 1/m
    double depth_noise_floor = 1e-3;  ///< s0 of it, m: what does not grow with depth
    double depth_scale_sigma = 0.01;  ///< one sigma of a share by which all depths, and so all ways, may err
    bool estimate_readout = true;     ///< learn the read-out time from the images; else it is readout_time
    double readout_sigma = 0.01;      ///< how far from 0 the learned read-out time may well be, s, one sigma
    double readout_memory = 0.995;    ///< share of what was learned that is kept from frame to frame
    double readout_time = 0;     ///< time from the first to the last row of a rolling shutter, s (0: global)
    double blur_time = 0.0035;   ///< one sigma of when an edge was seen (exposure, stamps), s; 0: sharp
    double reference_row = 0.5;  ///< row whose time the stamp means, as a share of the height

    /// sigma_z at a depth, m.
    double depthSigma(double depth) const {
        const double grown = depth_noise * depth * depth;
        return std::sqrt(depth_noise_floor * depth_noise_floor + grown * grown);
    }
};

struct EdgeOptions {
    double blur_sigma = 0;           ///< Gaussian blur before the Sobel filter, px (0: none)
    double canny_factor = 1.5;       ///< high threshold = factor x Otsu's (of the magnitudes' square roots)
    double canny_low_ratio = 0.5;    ///< low threshold = ratio x high
    double min_high_threshold = 24;  ///< floor of the high threshold, Sobel units (8 per grey level of ramp)
    double angle_deg = 20;           ///< oriented BFS: largest angle between neighbouring gradients
    int min_length = 10;             ///< shortest organized edge, px
    int tangent_span = 4;         ///< tangents are taken between the points this many places before and after
    int depth_patch_radius = 2;   ///< of the square of foreground depths, px; wider if sparse
    double depth_jump = 0.03;     ///< relative depth step that separates foreground from background
    bool two_sided_depth = true;  ///< keyframe depths corrected by the surfaces on both sides of each edge
};

struct CoarseOptions {
    int levels = 4;           ///< image pyramid levels
    int max_points = 800;     ///< sampled edge points
    int min_points = 30;      ///< fewer cannot carry a photometric pose
    int max_iterations = 12;  ///< Gauss-Newton steps per level
};

struct FineOptions {
    double search_radius = 6;     ///< first association, px
    double final_radius = 3;      ///< last association, px
    double normal_angle_deg = 5;  ///< between the reprojected edge's normal and the candidate's
    double vote_ratio = 0.3;      ///< share of the shorter edge's points that must agree on a pair of edges
    int min_votes = 5;            ///< and at least this many points
    int max_points = 3500;        ///< keyframe edge points used
    int max_iterations = 12;      ///< Gauss-Newton steps
    double chi2 = 16;             ///< chi-square limit of a residual
    double photometric_weight =
        0.05;                   ///< alpha^2 of Eq. (9) after both residuals are normalised by their spread
    double depth_weight = 0.4;  ///< weight of the depth residual of associated points (0: as in the paper)
    double depth_chi2 = 12;     ///< chi-square limit of a depth residual
    int min_inliers = 40;       ///< fewer inliers: the frame is not tracked
    double min_matched_ratio =
        0.3;  ///< share of the visible edges that must be associated in a tracked frame
};

struct KeyframeOptions {
    double min_overlap = 0.7;       ///< new keyframe below this share of associable edges
    double max_rotation_deg = 15;   ///< new keyframe beyond this rotation
    double max_translation = 0.15;  ///< new keyframe beyond this translation, relative to the median depth
};

/// The motion that is thought likely: it decides in directions that the edges hardly see.
struct MotionOptions {
    double acceleration = 5;                ///< m/s^2, one sigma
    double angular_acceleration_deg = 500;  ///< deg/s^2, one sigma
    double speed = 1;                       ///< m/s, one sigma where no velocity is known
    double angular_speed_deg = 60;          ///< deg/s, one sigma where no velocity is known
    bool smooth = true;                     ///< final poses are smoothed; live ones never are
};

struct LossOptions {
    int max_predicted = 10;  ///< frames bridged by constant velocity
    bool recognise = true;   ///< a lost camera is looked for at all keyframes
};

/// Local mapping, in mode ba (except where said).
struct MappingOptions {
    int window = 20;               ///< newest keyframes that are refined together
    int max_points = 2500;         ///< edge points kept of a keyframe
    int max_iterations = 6;        ///< of the bundle adjustment, per keyframe
    bool joint_refinement = true;  ///< poses move together; else each is registered alone, as in the paper
    double chi2 = 16;              ///< chi-square limit of a point-to-tangent residual
    double depth_weight = 0.3;     ///< weight of the depth of an observation
    double depth_chi2 = 12;        ///< chi-square limit of a depth
    double prior_weight = 0.15;    ///< weight of the tracked motion between keyframes, against all points
    double max_spread = 16;        ///< sigmas; an edge whose observations differ by more is a pseudo-edge
    double min_seen = 0.5;         ///< share of the keyframes that look at an edge's place and must see it
    int min_looks = 3;             ///< fewer of them cannot judge; one that looks from the side counts less
    bool reuse_keyframes = true;   ///< old keyframes that look at the same place take part again
    int max_reused = 4;            ///< at most this many of them
    bool close_loops = true;       ///< places that are recognised correct the whole path since
    int final_rounds = 20;         ///< most rounds in which all keyframes are refined together at the end
    bool deterministic = true;     ///< the tracker waits for the map; else it takes what is ready
    int latency = 4;               ///< frames after which the mapping of a keyframe takes effect
    double pseudo_weight = 0.3;    ///< what pseudo-edges of the keyframe still count in tracking
    /// Surface points kept of a keyframe, next to its edges (0: none); in all modes. 10 bytes each.
    int semi_dense_points = 2500;
};

struct OdometryOptions {
    Mode mode = Mode::kBundleAdjustment;
    int threads = 0;  ///< 1: all in the caller's; 0: as many as there are processors. Results are the same
    SensorOptions sensor;
    EdgeOptions edges;
    CoarseOptions coarse;
    FineOptions fine;
    KeyframeOptions keyframe;
    MotionOptions motion;
    MappingOptions mapping;
    LossOptions loss;
};

/// One entry of the option table: where it lives, what it means, and a pointer into a given OdometryOptions.
struct OptionField {
    std::string section, key;
    std::string unit;         ///< "" when dimensionless
    std::string description;  ///< one sentence
    double min = 0, max = 0;  ///< inclusive range (unused for bool and mode)
    std::variant<double*, int*, bool*, Mode*> value;

    std::string name() const { return section + "." + key; }
    std::string toText() const;
    /// Parses text into the option. Returns an empty string, or one line naming the option, the text and the
    /// fault.
    std::string fromText(const std::string& text) const;
    /// Empty when the present value is in range, else one line naming the option, its value and the range.
    std::string check() const;
};

/// The table over `options`; the pointers live as long as `options`.
std::vector<OptionField> optionFields(OdometryOptions& options);

/// Sets one option by "section.key". Returns an empty string or one line of error (an unknown key names the
/// closest known one, or ones).
std::string setOption(OdometryOptions& options, const std::string& name, const std::string& text);

/// Empty when all options are in range, else the first fault in one line.
std::string checkOptions(const OdometryOptions& options);

/// OdometryOptions::threads, and where that is 0 the processors that this process may use; at least 1.
int threadCount(int threads);

const char* toString(Mode mode);

}  // namespace roevo
